// Progress of long work on a terminal, and the wish to stop.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>

namespace lab {

/// One line on stderr that is redrawn, if that is a terminal.
class progress_bar {
  public:
    explicit progress_bar(std::size_t steps)
        : steps_(std::max<std::size_t>(steps, 1)), visible_(::isatty(STDERR_FILENO) == 1) {}
    ~progress_bar() {
        if (visible_) {
            std::fputs("\r\x1b[K", stderr);
        }
    }
    progress_bar(const progress_bar&) = delete;
    progress_bar& operator=(const progress_bar&) = delete;

    void show(const std::string& doing) {
        if (!visible_) {
            return;
        }
        constexpr std::size_t width = 30;
        const std::size_t full = width * std::min(done_, steps_) / steps_;
        std::fprintf(stderr, "\r\x1b[K[%s%s] %zu/%zu %s", std::string(full, '#').c_str(),
                     std::string(width - full, '.').c_str(), done_, steps_, doing.c_str());
        std::fflush(stderr);
    }
    void advance() { ++done_; }

  private:
    std::size_t steps_;
    std::size_t done_ = 0;
    bool visible_;
};

/// Throws when the user asked to stop; long work calls it between its steps.
void stop_if_asked();

/// Asks to stop; may be called by a signal handler.
void ask_to_stop();

} // namespace lab
