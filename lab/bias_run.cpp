#include "lab/bias_run.hpp"

#include <warpshadow/bias.hpp>

namespace lab {

void run_method(run_record& record, renderer& gpu, const view_request& request,
                const g_buffer_samples& samples, std::span<const std::uint8_t> truth,
                std::shared_ptr<standing_view>* kept) {
    view_request settled = request;
    if (settled.bias && settled.bias->kind == bias_kind::constant && !settled.bias->value) {
        view_request first = settled;
        first.bias->kind = bias_kind::none;
        first.filter = {};
        first.repeat = 1;
        settled.bias->value = least_constant(samples, truth, gpu.run(record.method, first).biases);
    }
    record.result = gpu.run(record.method, settled, kept);
    record.against_truth = compare(samples, truth, record.result.shadowed);
    if (settled.bias) {
        record.bias = settled.bias->label;
        record.bias_effect =
            measure_bias(samples, truth, record.result.shadowed, record.result.biases);
        record.bias_effect.value = settled.bias->value.value_or(
            settled.bias->kind == bias_kind::slope ? warpshadow::polygon_offset_factor(0.0) : 0.0);
    }
}

} // namespace lab
