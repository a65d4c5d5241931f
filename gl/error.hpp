// The one exception of the GL layer.
#pragma once

#include <stdexcept>

namespace gl {

/// What went wrong with the context, a shader or an object; `what()` is meant to be printed.
class error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

} // namespace gl
