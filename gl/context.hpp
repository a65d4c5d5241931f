// Headless OpenGL context through EGL.
#pragma once

#include "gl/error.hpp"

#include <memory>
#include <string>

namespace gl {

/// What the current context runs on.
struct context_info {
    std::string renderer; ///< GL_RENDERER
    std::string version;  ///< GL_VERSION
    std::string platform; ///< how EGL found it: "device" or "surfaceless", empty for a window
    int major = 0;
    int minor = 0;
    bool software = false; ///< llvmpipe, softpipe, swrast: timer queries mean nothing there
};

/// Describes the context that is current on this thread.
context_info describe_current_context();

/// Sends KHR_debug messages of high severity to stderr, one line each.
void report_high_severity_messages();

/// An OpenGL core context of version 4.3 or newer without a window, current on this thread.
///
/// Tries the EGL device platform first (hardware devices before software ones), then Mesa's
/// surfaceless platform.
class headless_context {
  public:
    /// @throws gl::error with one line that says what was tried.
    headless_context();
    ~headless_context();
    headless_context(const headless_context&) = delete;
    headless_context& operator=(const headless_context&) = delete;

    [[nodiscard]] const context_info& info() const { return info_; }

  private:
    struct handles;
    std::unique_ptr<handles> handles_;
    context_info info_;
};

} // namespace gl
