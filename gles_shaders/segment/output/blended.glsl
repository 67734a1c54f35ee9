// What is drawn is blended by fixed function with what is there.
layout(location = 0) out highp vec4 colour;
