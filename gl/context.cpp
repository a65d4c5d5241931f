#include "gl/context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string_view>
#include <vector>

namespace gl {
namespace {

std::string gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

void GLAPIENTRY print_message(GLenum source, GLenum /*type*/, GLuint /*id*/, GLenum severity,
                              GLsizei length, const GLchar* message, const void* /*user*/) {
    // gl::program reports what the compiler says, with file names
    if (severity != GL_DEBUG_SEVERITY_HIGH || source == GL_DEBUG_SOURCE_SHADER_COMPILER) {
        return;
    }
    std::string_view text = length < 0
                                ? std::string_view(message)
                                : std::string_view(message, static_cast<std::size_t>(length));
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
        text.remove_suffix(1);
    }
    std::fprintf(stderr, "GL: %.*s\n", static_cast<int>(text.size()), text.data());
}

struct candidate {
    EGLDisplay display;
    const char* platform;
};

bool has_client_extension(const char* name) {
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, name);
}

/// Displays in the order in which they are tried.
std::vector<candidate> candidates() {
    std::vector<candidate> result;
    if (!has_client_extension("EGL_EXT_platform_base")) {
        return result;
    }
    if (has_client_extension("EGL_EXT_platform_device") &&
        (has_client_extension("EGL_EXT_device_enumeration") ||
         has_client_extension("EGL_EXT_device_base"))) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) ==
            EGL_TRUE) {
            std::vector<EGLDeviceEXT> found(devices.begin(), devices.begin() + count);
            const bool can_ask = has_client_extension("EGL_EXT_device_query") ||
                                 has_client_extension("EGL_EXT_device_base");
            std::stable_partition(found.begin(), found.end(), [&](EGLDeviceEXT device) {
                const char* text =
                    can_ask ? eglQueryDeviceStringEXT(device, EGL_EXTENSIONS) : nullptr;
                return text == nullptr ||
                       std::string_view(text).find("device_software") == std::string_view::npos;
            });
            for (EGLDeviceEXT device : found) {
                result.push_back(
                    {eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr), "device"});
            }
        }
    }
    if (has_client_extension("EGL_MESA_platform_surfaceless")) {
        result.push_back(
            {eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
             "surfaceless"});
    }
    return result;
}

} // namespace

context_info describe_current_context() {
    context_info info;
    info.renderer = gl_string(GL_RENDERER);
    info.version = gl_string(GL_VERSION);
    glGetIntegerv(GL_MAJOR_VERSION, &info.major);
    glGetIntegerv(GL_MINOR_VERSION, &info.minor);
    std::string lower = info.renderer;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "software rasterizer"}) {
        info.software = info.software || lower.find(name) != std::string::npos;
    }
    return info;
}

void report_high_severity_messages() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(print_message, nullptr);
}

struct headless_context::handles {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    handles() = default;
    handles(const handles&) = delete;
    handles& operator=(const handles&) = delete;
    ~handles() {
        if (display == EGL_NO_DISPLAY) {
            return;
        }
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context != EGL_NO_CONTEXT) {
            eglDestroyContext(display, context);
        }
        eglTerminate(display);
    }

    /// Empty on success, else why this display does not serve.
    std::string open(EGLDisplay on) {
        EGLint major = 0;
        EGLint minor = 0;
        if (on == EGL_NO_DISPLAY || eglInitialize(on, &major, &minor) != EGL_TRUE) {
            return "cannot be initialised";
        }
        display = on;
        if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) {
            return "needs a surface";
        }
        if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
            return "has no desktop OpenGL";
        }
        EGLConfig config = nullptr;
        if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
            const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                               EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
            EGLint count = 0;
            if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE ||
                count == 0) {
                return "has no usable configuration";
            }
        }
        const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                               4,
                                               EGL_CONTEXT_MINOR_VERSION,
                                               3,
                                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                               EGL_NONE};
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
        if (context == EGL_NO_CONTEXT) {
            return "gives no OpenGL 4.3 core context";
        }
        if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
            return "cannot make its context current";
        }
        return {};
    }
};

headless_context::headless_context() {
    if (!epoxy_has_egl()) {
        throw error("no OpenGL: libEGL is not installed");
    }
    std::string tried;
    for (const candidate& next : candidates()) {
        auto attempt = std::make_unique<handles>();
        const std::string reason = attempt->open(next.display);
        if (reason.empty()) {
            handles_ = std::move(attempt);
            info_ = describe_current_context();
            info_.platform = next.platform;
            report_high_severity_messages();
            return;
        }
        tried += (tried.empty() ? "" : "; ") + std::string(next.platform) + " " + reason;
    }
    throw error("no OpenGL 4.3 core context without a window (" +
                (tried.empty() ? std::string("EGL offers neither devices nor surfaceless displays")
                               : tried) +
                ")");
}

headless_context::~headless_context() = default;

} // namespace gl
