#include <algorithm>
#include <cmath>

#include "core/gl/state_guard.h"
#include "tests/support/render_support.h"

namespace slabcast::test {

namespace {

constexpr glm::ivec2 kSmall(80, 60);
constexpr Viewport kWhole{0, 0, kSmall.x, kSmall.y};

/// A framebuffer of the host's, of any colour format.
class HostTarget {
public:
    explicit HostTarget(GLenum format) : format_(format) {
        texture_ = gl::Texture::make("host's texture", GL_TEXTURE_2D);
        framebuffer_ = gl::Framebuffer::make("host's framebuffer");
        gl::BindTexture(GL_TEXTURE_2D, texture_.id());
        gl::TexStorage2D(GL_TEXTURE_2D, 1, format, kSmall.x, kSmall.y);
        gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl::FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.id(),
                                 0);
        EXPECT_EQ(gl::CheckFramebufferStatus(GL_FRAMEBUFFER),
                  static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
    }
    unsigned id() const { return framebuffer_.id(); }

    /// As it lies in memory: encoded where the format encodes.
    void fill(glm::dvec4 stored) const {
        glm::vec4 value(stored);
        if (format_ == GL_SRGB8_ALPHA8) {
            value = glm::vec4(glm::dvec4(linearFromSrgb(glm::dvec3(stored)), stored.a));
        }
        gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl::ClearBufferfv(GL_COLOR, 0, &value.x);
    }
    Picture read() const {
        gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl::StateGuard::usePlainPacking();
        Picture picture{kSmall, std::vector<glm::vec4>(std::size_t(kSmall.x) * kSmall.y)};
        if (format_ == GL_RGBA16F) {
            gl::ReadPixels(0, 0, kSmall.x, kSmall.y, GL_RGBA, GL_FLOAT, picture.pixels.data());
            return picture;
        }
        std::vector<glm::u8vec4> bytes(picture.pixels.size());
        gl::ReadPixels(0, 0, kSmall.x, kSmall.y, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
        std::transform(bytes.begin(), bytes.end(), picture.pixels.begin(),
                       [](glm::u8vec4 b) { return glm::vec4(b) / 255.0F; });
        return picture;
    }

private:
    GLenum format_;
    gl::Texture texture_;
    gl::Framebuffer framebuffer_;
};

struct TargetCase {
    const char* name;
    TargetEncoding encoding;
    GLenum format;
    double step; // largest error of one blend
};

// GL may blend in the target's own precision: colour, opacity and result are then rounded to 8 bits
// one by one. An sRGB format blends in more, and rounds once; GL allows its conversion another half
// step.
constexpr TargetCase kTargets[] = {
    {"encoded", TargetEncoding::Encoded, GL_RGBA8, 3.0 / 510.0},
    {"linear", TargetEncoding::Linear, GL_RGBA16F, 0x1p-11},
    {"sRGB format", TargetEncoding::SrgbFormat, GL_SRGB8_ALPHA8, 2.0 / 510.0},
};

using Conversion = glm::dvec3 (*)(glm::dvec3);

glm::dvec3 same(glm::dvec3 c) {
    return c;
}

/// From the compositing space to the one in which the target blends: an sRGB format blends light.
Conversion conversionFor(CompositingSpace space, TargetEncoding encoding) {
    const bool blendsLight = encoding != TargetEncoding::Encoded;
    const bool compositesLight = space == CompositingSpace::Linear;
    if (blendsLight == compositesLight) {
        return same;
    }
    return blendsLight ? Conversion(linearFromSrgb) : Conversion(srgbFromLinear);
}

struct Range {
    glm::dvec3 low, high;

    Range mapped(Conversion convert) const {
        return {convert(glm::max(low, 0.0)), convert(glm::max(high, 0.0))};
    }
    Range scaled(double factor) const { return {low * factor, high * factor}; }
    Range grown(double by) const { return {low - by, high + by}; }
    Range movedBy(glm::dvec3 by) const { return {low + by, high + by}; }
    double excess(glm::dvec3 c) const {
        const glm::dvec3 off = glm::max(low - c, c - high);
        return std::max({off.x, off.y, off.z});
    }
};

/// What a pixel may hold: the reference's colour with what rounding may add to it, converted as a
/// straight colour, composited over `stored` in the space that the target blends in, and rounded
/// once more.
Range expectedRange(const PixelReference& reference, double layerError, CompositingSpace space,
                    const TargetCase& target, glm::dvec3 stored) {
    const double alpha = reference.color.a;
    const double error = reference.bound + layerError;
    const bool encodes = target.encoding == TargetEncoding::SrgbFormat;
    const glm::dvec3 behind = (encodes ? linearFromSrgb(stored) : stored) * (1.0 - alpha);
    const Conversion convert = conversionFor(space, target.encoding);
    Range range{glm::dvec3(reference.color), glm::dvec3(reference.color)};
    if (convert != same && alpha > 0.0) {
        // Colour and opacity each err by `error`: the straight colour by their sum over alpha.
        range = range.scaled(1.0 / alpha).grown(2.0 * error / alpha).mapped(convert).scaled(alpha);
    }
    range = range.grown(2.0 * error).movedBy(behind); // of the colour, and of what shines through
    return (encodes ? range.mapped(srgbFromLinear) : range).grown(target.step);
}

class EncodingTest : public RenderTest {
protected:
    void expectRight(CompositingSpace space, const TargetCase& target, bool opaque) {
        SCOPED_TRACE(std::string(slabcast::name(space)) + " into " + target.name +
                     (opaque ? ", opaque" : ""));
        Random random(7);
        const Volume volume = wavyVolume(random, {22, 22, 22}, VoxelType::U8);
        TransferFunction tf = smoothTransfer(random, 255.0, opaque ? 1.0 : 0.12);
        const Scene scene = makeScene(volume, {.tf = tf, .space = space}, {}, true);
        Settings settings = segments(kAll, SegmentForm::Loop); // one plane: rounded once
        settings.space = space;
        const FramePlan plan = decide(scene, settings);
        const View view = orbitView(scene, {25.0, 15.0, 2.3}, 45.0, kSmall);
        const glm::dvec3 stored(64.0 / 255.0, 128.0 / 255.0, 192.0 / 255.0);
        const HostTarget host(target.format);
        host.fill(glm::dvec4(stored, 1.0));
        const ViewTarget where{view, host.id(), kWhole, target.encoding};
        ASSERT_TRUE(renderer().prepare(scene, plan, {&where, 1}).has_value());
        ASSERT_TRUE(renderer().draw(scene, plan, {&where, 1}).has_value());

        const Picture picture = host.read();
        const ReferencePicture reference(scene, plan, view, kWhole);
        double worst = -1.0;
        int halfTransparent = 0;
        for (int y = 0; y < kSmall.y; ++y) {
            for (int x = 0; x < kSmall.x; ++x) {
                const PixelReference pixel = reference.at(glm::dvec2(x, y) + 0.5);
                halfTransparent += pixel.color.a > 0.2 && pixel.color.a < 0.8;
                const Range range = expectedRange(pixel, 0x1p-11, space, target, stored);
                worst = pixel.atEdge
                            ? worst
                            : std::max(worst, range.excess(glm::dvec3(picture.at({x, y}))));
            }
        }
        EXPECT_LE(worst, 0.0);
        EXPECT_TRUE(opaque || halfTransparent > 500) << halfTransparent;
    }
};

} // namespace

TEST_F(EncodingTest, EverySpaceIntoEveryTarget) {
    for (const CompositingSpace space : {CompositingSpace::Display, CompositingSpace::Linear}) {
        for (const TargetCase& target : kTargets) {
            expectRight(space, target, false);
            expectRight(space, target, true);
        }
    }
}

// Two views of one call through a layer of our own, of different sizes: each gets its own picture.
TEST_F(EncodingTest, ViewsOfDifferentSizeShareTheLayer) {
    Random random(8);
    const Volume volume = wavyVolume(random, {20, 20, 20}, VoxelType::U8);
    const Scene scene = makeScene(
        volume, {.tf = smoothTransfer(random, 255.0, 0.2), .space = CompositingSpace::Linear});
    Settings settings = segments(8, SegmentForm::Loop);
    settings.space = CompositingSpace::Linear;
    const FramePlan plan = decide(scene, settings);
    const auto view = [&](glm::ivec2 size) {
        return orbitView(scene, {25.0, 15.0, 2.3}, 45.0, size);
    };
    const Viewport places[] = {{0, 0, 50, 30}, {51, 20, 29, 40}};
    const HostTarget both(GL_RGBA8);
    both.fill(glm::dvec4(0.0));
    std::vector<ViewTarget> targets;
    for (const Viewport& v : places) {
        targets.push_back({view({v.width, v.height}), both.id(), v, TargetEncoding::Encoded});
    }
    ASSERT_TRUE(renderer().prepare(scene, plan, targets).has_value());
    ASSERT_TRUE(renderer().draw(scene, plan, targets).has_value());
    const Picture together = both.read();
    for (std::size_t k = 0; k < 2; ++k) {
        const HostTarget alone(GL_RGBA8);
        alone.fill(glm::dvec4(0.0));
        ViewTarget single = targets[k];
        single.framebuffer = alone.id();
        ASSERT_TRUE(renderer().draw(scene, plan, {&single, 1}).has_value());
        const Picture part = alone.read().part(places[k]);
        EXPECT_EQ(differingPixels(part, together.part(places[k])), 0);
        EXPECT_TRUE(std::any_of(part.pixels.begin(), part.pixels.end(),
                                [](glm::vec4 p) { return p.a > 0.1F; }));
    }
}

} // namespace slabcast::test
