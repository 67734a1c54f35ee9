// Colour and extinction of a value, or premultiplied colour and opacity of a layer: from the
// transfer function's table, one for all labels and sides.
precision highp sampler2D;
uniform sampler2D transferTable;
#include TABLE_FILE

vec4 materialOf(float value, int label, int side) {
    return tableAt(value);
}
