// Time of GPU work.
#pragma once

#include "gl/objects.hpp"

#include <chrono>

namespace gl {

/// How GPU work is timed.
enum class timing {
    timer_query, ///< GL_TIME_ELAPSED
    glfinish     ///< wall clock between two glFinish, where queries mean nothing
};

/// glfinish on software renderers, timer_query elsewhere; asks the current context.
timing best_timing();

/// "timer_query" or "glfinish".
const char* timing_name(timing how);

/// Times one piece of work at a time.
class stopwatch {
  public:
    explicit stopwatch(timing how);
    void start();
    /// Milliseconds since start(); waits for the work to be done.
    double stop();

  private:
    timing how_;
    handle<detail::delete_query> query_;
    std::chrono::steady_clock::time_point begin_;
};

} // namespace gl
