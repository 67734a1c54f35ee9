#include "core/scene/table_texture.h"

#include <algorithm>
#include <bit>

#include "core/scene/volume_texture.h"

namespace slabcast {

namespace {

bool alike(const TexelLayout& a, const TexelLayout& b) {
    return a.internalFormat == b.internalFormat && a.filter == b.filter;
}

/// A row that is fetched texel by texel may be longer than its table. One that is filtered, and a
/// square, are read by coordinates that count from their edges.
bool holds(glm::ivec2 texture, const TableTexels& table) {
    const bool fetched = table.layout.filter == GL_NEAREST;
    return fetched ? texture.y == 1 && texture.x >= table.size.x : texture == table.size;
}

/// So long that tables which grow from edit to edit seldom need another.
glm::ivec2 withRoom(glm::ivec2 table, const gl::Caps& caps) {
    const auto length = static_cast<std::int64_t>(std::bit_ceil(static_cast<unsigned>(table.x)));
    return table.y == 1 ? glm::ivec2(int(std::min(length, caps.maxTextureSize)), 1) : table;
}

} // namespace

/// Texels as they are uploaded. A filtered row is filled with the last texel, which holds for all
/// values beyond, to a length that is a power of two: so a place in it is the same number for a
/// scene that is edited and one that is not.
TableTexels TableTexture::texelsOf(const Scene& scene, const Content& content,
                                   const gl::Caps& caps) {
    if (const PreintegratedTable* square = scene.preintegrated()) {
        return squareTableTexels(square->texels);
    }
    const TransferTable& table = scene.table();
    if (content == Content{}) {
        return tableTexels(table.texels, table.wide);
    }
    row_ = table.texels;
    if (content.bakedLengthMm > 0.0) {
        bakeLength(row_, table.extinctionPerMm * content.bakedLengthMm);
    }
    if (!content.filtered) {
        return tableTexels(row_, table.wide);
    }
    const glm::ivec2 size(static_cast<int>(row_.size()), 1);
    row_.resize(static_cast<std::size_t>(withRoom(size, caps).x), row_.back());
    return filteredTableTexels(row_);
}

Result<void> TableTexture::fill(const Scene& scene, const Content& content, const gl::Caps& caps) {
    const bool edited = scene.live() != nullptr;
    if (!edited) {
        release(); // before the next is allocated
    }
    const TableTexels table = texelsOf(scene, content, caps);
    if (Result<void> fits = checkTable(table, caps); !fits) {
        return fits;
    }
    const std::size_t next = edited ? (current_ + 1) % kTurns : 0;
    Slot& slot = slots_[next];
    if (!slot.texture || !alike(slot.layout, table.layout) || !holds(slot.size, table)) {
        slot.texture.release();
        const glm::ivec2 size = edited ? withRoom(table.size, caps) : table.size;
        Result<gl::Texture> made = allocate2d("transfer table", table.layout, size);
        if (!made) {
            return tl::unexpected(made.error());
        }
        slot = {std::move(*made), table.layout, size};
    }
    fill2d(slot.texture, table.layout, table.size, table.data);
    current_ = next;
    return {};
}

std::int64_t TableTexture::bytes() const {
    std::int64_t sum = 0;
    for (const Slot& slot : slots_) {
        sum += slot.texture ? slot.layout.bytesPerTexel * slot.size.x * slot.size.y : 0;
    }
    return sum;
}

void TableTexture::release() {
    slots_ = {};
    current_ = 0;
}

void TableTexture::forget() {
    for (Slot& slot : slots_) {
        slot.texture.forget();
    }
    release();
}

} // namespace slabcast
