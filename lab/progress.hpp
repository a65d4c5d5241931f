// Progress of long work on a terminal, and the wish to stop.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <ratio>
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
        std::fprintf(stderr, "\r\x1b[K[%s%s] %zu/%zu%s %s", std::string(full, '#').c_str(),
                     std::string(width - full, '.').c_str(), done_, steps_, left().c_str(),
                     doing.c_str());
        std::fflush(stderr);
    }
    void advance() { ++done_; }

  private:
    /// Minutes that the rest takes if it goes on as before; nothing where that is not known or
    /// soon.
    [[nodiscard]] std::string left() const {
        const std::chrono::duration<double, std::ratio<60>> gone =
            std::chrono::steady_clock::now() - begin_;
        const double minutes =
            done_ == 0 || done_ > steps_
                ? 0.0
                : gone.count() * static_cast<double>(steps_ - done_) / static_cast<double>(done_);
        return gone.count() < 0.1 || minutes < 1.0
                   ? std::string()
                   : " " + std::to_string(static_cast<long>(minutes)) + " min left,";
    }

    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::size_t steps_;
    std::size_t done_ = 0;
    bool visible_;
};

/// Throws when the user asked to stop; long work calls it between its steps.
void stop_if_asked();

/// Asks to stop; may be called by a signal handler.
void ask_to_stop();

} // namespace lab
