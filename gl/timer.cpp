#include "gl/timer.hpp"

#include "gl/context.hpp"

namespace gl {

timing best_timing() {
    return describe_current_context().software ? timing::glfinish : timing::timer_query;
}

const char* timing_name(timing how) {
    return how == timing::timer_query ? "timer_query" : "glfinish";
}

stopwatch::stopwatch(timing how) : how_(how) {
    if (how_ == timing::timer_query) {
        GLuint id = 0;
        glGenQueries(1, &id);
        query_ = handle<detail::delete_query>(id);
    }
}

void stopwatch::start() {
    if (how_ == timing::timer_query) {
        glBeginQuery(GL_TIME_ELAPSED, query_.id());
        return;
    }
    glFinish();
    begin_ = std::chrono::steady_clock::now();
}

double stopwatch::stop() {
    if (how_ == timing::timer_query) {
        glEndQuery(GL_TIME_ELAPSED);
        GLuint64 nanoseconds = 0;
        glGetQueryObjectui64v(query_.id(), GL_QUERY_RESULT, &nanoseconds);
        return static_cast<double>(nanoseconds) * 1e-6;
    }
    glFinish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_)
        .count();
}

} // namespace gl
