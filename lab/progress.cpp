#include "lab/progress.hpp"

#include <csignal>
#include <stdexcept>

namespace lab {
namespace {
volatile std::sig_atomic_t stop_asked = 0;
} // namespace

void ask_to_stop() {
    stop_asked = 1;
}

void stop_if_asked() {
    if (stop_asked != 0) {
        throw std::runtime_error("interrupted");
    }
}

} // namespace lab
