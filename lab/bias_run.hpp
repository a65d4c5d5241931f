// One method, with a bias that is measured.
#pragma once

#include "lab/bias.hpp"
#include "lab/methods.hpp"
#include "lab/results.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lab {

/// Runs a method and measures its bias, if it has one; finds the constant first where that is
/// wanted. Fills result, comparison and what the bias did of a record.
void run_method(run_record& record, renderer& gpu, const view_request& request,
                const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                std::shared_ptr<standing_view>* kept = nullptr);

} // namespace lab
