#include "core/scene/table_texture.h"

#include <algorithm>
#include <bit>

#include "core/scene/volume_texture.h"

namespace slabcast {

namespace {

bool alike(const TexelLayout& a, const TexelLayout& b) {
    return a.internalFormat == b.internalFormat && a.filter == b.filter;
}

/// A row may be longer than its table: it is fetched texel by texel. A square is filtered, by
/// coordinates that count from its edges.
bool holds(glm::ivec2 texture, glm::ivec2 table) {
    return table.y == 1 ? texture.y == 1 && texture.x >= table.x : texture == table;
}

/// So long that tables which grow from edit to edit seldom need another.
glm::ivec2 withRoom(glm::ivec2 table, const gl::Caps& caps) {
    const auto length = static_cast<std::int64_t>(std::bit_ceil(static_cast<unsigned>(table.x)));
    return table.y == 1 ? glm::ivec2(int(std::min(length, caps.maxTextureSize)), 1) : table;
}

TableTexels tableTexelsOf(const Scene& scene) {
    const PreintegratedTable* square = scene.preintegrated();
    return square != nullptr ? squareTableTexels(square->texels)
                             : tableTexels(scene.table().texels, scene.table().wide);
}

} // namespace

Result<void> TableTexture::fill(const Scene& scene, const gl::Caps& caps) {
    const bool edited = scene.live() != nullptr;
    if (!edited) {
        release(); // before the next is allocated
    }
    const TableTexels table = tableTexelsOf(scene);
    if (Result<void> fits = checkTable(table, caps); !fits) {
        return fits;
    }
    const std::size_t next = edited ? (current_ + 1) % kTurns : 0;
    Slot& slot = slots_[next];
    if (!slot.texture || !alike(slot.layout, table.layout) || !holds(slot.size, table.size)) {
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
