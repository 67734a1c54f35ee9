#include "core/gl/caps.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "core/gl/api.h"

namespace slabcast::gl {

namespace {

struct ExtensionFlag {
    const char* extension;
    bool Caps::*flag;
};

constexpr ExtensionFlag kFlags[] = {
    {"GL_EXT_texture_norm16", &Caps::norm16},
    {"GL_OES_texture_float_linear", &Caps::floatLinear},
    {"GL_EXT_float_blend", &Caps::floatBlend},
    {"GL_EXT_disjoint_timer_query", &Caps::timerQuery},
    {"GL_EXT_shader_framebuffer_fetch", &Caps::framebufferFetch},
    {"GL_OVR_multiview2", &Caps::multiview},
    {"GL_NV_image_formats", &Caps::imageFormats},
};

constexpr const char* kSoftwareRenderers[] = {"llvmpipe", "softpipe", "SwiftShader", "swrast"};

std::string text(GLenum name) {
    const GLubyte* bytes = GetString(name);
    return bytes == nullptr ? std::string() : reinterpret_cast<const char*>(bytes);
}

std::int64_t limit(GLenum name) {
    GLint64 value = 0;
    GetInteger64v(name, &value);
    return value;
}

DeviceStrings currentDeviceStrings() {
    DeviceStrings strings{text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION), {}};
    GLint count = 0;
    GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        const GLubyte* name = GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i));
        strings.extensions.emplace_back(reinterpret_cast<const char*>(name));
    }
    return strings;
}

} // namespace

Result<Caps> capsFrom(DeviceStrings strings, const std::vector<std::string>& maskedExtensions) {
    Caps caps;
    // "OpenGL ES 3.2 Mesa ...": the form that the ES specification asks for (section 20.2).
    const int found =
        std::sscanf(strings.version.c_str(), "OpenGL ES %d.%d", &caps.major, &caps.minor);
    if (found != 2 || caps.major < 3 || (caps.major == 3 && caps.minor < 2)) {
        return fail(ErrorCode::DeviceUnsupported,
                    "GLES 3.2 is needed, but " + strings.renderer + " offers \"" + strings.version +
                        "\"; update the graphics driver or choose another device");
    }
    caps.vendor = std::move(strings.vendor);
    caps.renderer = std::move(strings.renderer);
    caps.driver = std::move(strings.version);
    caps.extensions = std::move(strings.extensions);
    std::erase_if(caps.extensions, [&](const std::string& extension) {
        return std::find(maskedExtensions.begin(), maskedExtensions.end(), extension) !=
               maskedExtensions.end();
    });
    std::sort(caps.extensions.begin(), caps.extensions.end());
    for (const ExtensionFlag& row : kFlags) {
        caps.*row.flag |= std::binary_search(caps.extensions.begin(), caps.extensions.end(),
                                             std::string(row.extension));
    }
    caps.isSoftware = std::any_of(
        std::begin(kSoftwareRenderers), std::end(kSoftwareRenderers),
        [&](const char* name) { return caps.renderer.find(name) != std::string::npos; });
    return caps;
}

Result<Caps> queryCaps(const std::vector<std::string>& maskedExtensions) {
    if (GetString == nullptr) {
        return fail(ErrorCode::InvalidArgument,
                    "GL's functions are not loaded: call gl::loadApi() before, with a context "
                    "current");
    }
    Result<Caps> caps = capsFrom(currentDeviceStrings(), maskedExtensions);
    if (caps) {
        caps->maxTextureSize = limit(GL_MAX_TEXTURE_SIZE);
        caps->maxTexture3DSize = limit(GL_MAX_3D_TEXTURE_SIZE);
        caps->maxUniformBlockSize = limit(GL_MAX_UNIFORM_BLOCK_SIZE);
        caps->maxComputeInvocations = limit(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
        caps->maxComputeSharedBytes = limit(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
        caps->maxComputeImages = limit(GL_MAX_COMPUTE_IMAGE_UNIFORMS);
        caps->maxComputeStorageBlocks = limit(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
        caps->maxStorageBlockBytes = limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    }
    return caps;
}

std::vector<std::string> mobileStrictMask() {
    return {
        "GL_EXT_texture_norm16",
        "GL_OES_texture_float_linear",
        "GL_EXT_float_blend",
        "GL_NV_image_formats",
        "GL_EXT_disjoint_timer_query",
        "GL_EXT_shader_framebuffer_fetch",
        "GL_EXT_shader_framebuffer_fetch_non_coherent",
        "GL_ARM_shader_framebuffer_fetch",
        "GL_EXT_texture_storage",
        "GL_EXT_render_snorm",
        "GL_EXT_clip_cull_distance",
        "GL_EXT_draw_buffers_indexed",
        "GL_OES_viewport_array",
        "GL_NV_conditional_render",
    };
}

std::vector<std::string> parseExtensionMask(const std::string& text) {
    if (text == "mobile-strict") {
        return mobileStrictMask();
    }
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        if (end > begin) {
            names.push_back(text.substr(begin, end - begin));
        }
        begin = end + 1;
    }
    return names;
}

} // namespace slabcast::gl
