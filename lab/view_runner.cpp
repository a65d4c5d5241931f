#include "lab/view_runner.hpp"

#include "lab/bias_run.hpp"
#include "lab/measure.hpp"
#include "lab/method_table.hpp"
#include "lab/picture.hpp"
#include "lab/statistics.hpp"
#include "lab/view_arguments.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lab {
namespace {

/// One run that is wanted of a view.
struct planned_run {
    std::string method;
    int map; ///< 0: a method without a map
    std::optional<bias_choice> bias;
    std::optional<raster_choice> raster;
    const run_variant* variant = nullptr; ///< something else than the command line has
};

/// Nothing where nothing was asked for: one run, with the default.
template <typename T> std::vector<std::optional<T>> or_default(const std::vector<T>& asked) {
    std::vector<std::optional<T>> result(asked.begin(), asked.end());
    if (result.empty()) {
        result.emplace_back();
    }
    return result;
}

std::vector<planned_run> plan_runs(const options& wanted, const light_view& light) {
    std::vector<planned_run> result;
    for (const int map : wanted.maps) {
        for (const std::string& method : wanted.methods) {
            const bool once = !has_maps(method);
            if ((once && map != wanted.maps.front()) || why_not(method, light) ||
                why_not(method, wanted.set_up)) {
                continue;
            }
            if (once) {
                result.push_back({method, 0, {}, {}});
                continue;
            }
            const std::vector<raster_choice> rasters =
                has_tables(method) ? wanted.rasters : std::vector<raster_choice>{};
            for (const std::optional<bias_choice>& bias : or_default(wanted.biases)) {
                if (bias && why_not(method, light, *bias)) {
                    continue;
                }
                for (const std::optional<raster_choice>& raster : or_default(rasters)) {
                    result.push_back({method, map, bias, raster});
                }
            }
            // beside what they are set against: a machine that drifts hits both alike
            for (const run_variant& variant : wanted.variants) {
                if (variant.method == method && variant.map == map) {
                    result.push_back({method, map, {}, variant.raster, &variant});
                }
            }
        }
    }
    return result;
}

/// The ray tracer as a method: its own truth, timed.
std::vector<double> trace(method_result& result, const ray_tracer& rays,
                          const g_buffer_samples& samples, const light_view& light, int repeat) {
    std::vector<double> times;
    std::vector<double> frames;
    for (int i = 0; i < repeat; ++i) {
        traced_shadows traced = rays.shadows(samples, light);
        times.push_back(traced.ms);
        frames.push_back(samples.draw_ms + traced.ms);
        result.shadowed = std::move(traced.shadowed);
    }
    result.passes = {{"g-buffer", samples.draw_ms}, {"rays", median(times)}};
    return frames;
}

/// Memory of the device that runs may hold from round to round.
constexpr std::size_t most_standing_bytes = std::size_t(1) << 29;

/// Whether frames agree so well that another one would not move their median much.
bool is_settled(const method_result& result) {
    return result.frame_ms_max <= 1.05 * result.frame_ms_min;
}

/// One view with everything that its runs share.
class view_runner {
  public:
    view_runner(const options& wanted, const scene& world, renderer& gpu, const ray_tracer& rays,
                const camera_view& camera, const light_view& light, results& all,
                report_folder& folder, progress_bar& progress)
        : wanted_(wanted), world_(world), gpu_(gpu), rays_(rays), camera_(camera), light_(light),
          all_(all), folder_(folder), progress_(progress), samples_(gpu.samples(camera, light)),
          truth_(rays.shadows(samples_, light)), plan_(plan_runs(wanted, light)) {}

    view_pictures run() {
        const std::size_t first = all_.runs.size();
        standing_.resize(plan_.size());
        for (std::size_t i = 0; i < plan_.size(); ++i) {
            begin(plan_[i]);
            all_.runs.push_back(measured(plan_[i], standing_[i]));
            progress_.advance();
        }
        for (int round = 1; round < wanted_.rounds; ++round) {
            for (std::size_t i = 0; i < plan_.size(); ++i) {
                begin(plan_[i]);
                method_result& result = all_.runs[first + i].result;
                if (round == 1 || !is_settled(result)) {
                    add_times(result, more_frames(i, result));
                }
                progress_.advance();
            }
        }
        standing_.clear();
        return pictures(first);
    }

  private:
    std::vector<double> more_frames(std::size_t i, method_result& result) {
        return traces(plan_[i])
                   ? trace(result, rays_, samples_, light_, wanted_.repeat)
                   : gpu_.more_frames(plan_[i].method, request(plan_[i]), standing_[i].get());
    }

    static bool traces(const planned_run& each) { return each.method == "raytraced"; }

    void begin(const planned_run& each) {
        stop_if_asked();
        progress_.show(world_.name + " " + each.method +
                       (each.map == 0 ? std::string() : " " + std::to_string(each.map)));
    }

    view_request request(const planned_run& each) const {
        view_request result{
            camera_,        light_,         each.map,         wanted_.seed,
            wanted_.repeat, each.bias,      wanted_.filter,   each.raster.value_or(raster_choice{}),
            &rays_,         wanted_.tables, &truth_.shadowed, wanted_.set_up,
            is_shown(each)};
        if (each.variant != nullptr) {
            result.tables = each.variant->tables;
            result.filter = each.variant->filter.value_or(wanted_.filter);
            result.set_up = each.variant->set_up.value_or(wanted_.set_up);
        }
        return result;
    }

    /// Whether a run has pictures in the report, and times pass by pass.
    bool is_shown(const planned_run& each) const {
        return !traces(each) && each.variant == nullptr &&
               (wanted_.pictured == 0 || each.map == 0 || each.map == wanted_.pictured);
    }

    /// @param[out] standing what later rounds go on with, while there is room for it
    run_record measured(const planned_run& each, std::shared_ptr<standing_view>& standing) {
        run_record record{world_.name, camera_.label, light_.label, each.method, each.map, {}, {}};
        record.kind = kind_text(light_.light.kind);
        if (traces(each)) {
            add_times(record.result, trace(record.result, rays_, samples_, light_, wanted_.repeat));
            record.result.bytes = rays_.bytes();
            record.result.triangles = world_.triangles.size();
            record.against_truth = compare(samples_, truth_.shadowed, record.result.shadowed);
            return record;
        }
        const view_request asked = request(each);
        run_method(record, gpu_, asked, samples_, truth_.shadowed,
                   wanted_.rounds > 1 ? &standing : nullptr);
        if (standing) {
            standing_bytes_ += bytes_of(*standing);
            if (standing_bytes_ > most_standing_bytes) {
                standing_bytes_ -= bytes_of(*standing);
                standing.reset();
            }
        }
        if (each.raster) {
            record.raster = raster_name(*each.raster);
        }
        if (each.variant != nullptr) {
            record.variant = each.variant->name;
        }
        if (!record.result.light.empty()) {
            record.filter = filter_name(asked.filter);
            record.filtered = measure_filter(samples_, truth_.shadowed, record.result.light);
        }
        if (has_tables(each.method) && asked.tables.format == table_format::unorm16) {
            record.tables = "unorm16";
        }
        if (has_maps(each.method) && asked.set_up == precision::in_float) {
            record.set_up = "float";
        }
        return record;
    }

    view_pictures pictures(std::size_t first) {
        progress_.show(world_.name + " pictures");
        const shader shade(world_, rays_, samples_, camera_, light_);
        std::vector<std::span<const std::uint8_t>> marks;
        for (std::size_t i = first; i < all_.runs.size(); ++i) {
            if (all_.runs[i].method != "raytraced") {
                marks.emplace_back(all_.runs[i].against_truth.wrong);
            }
        }
        constexpr int zoom = 3;
        const glm::ivec2 window = glm::max(samples_.size / 4, glm::ivec2(1));
        const glm::ivec2 corner = window_of_difference(marks, samples_.size, window);

        const std::string place = "c" + camera_.label;
        const std::string lamp = "l" + light_.label;
        const picture reference = shade.shade(truth_.shadowed);
        view_pictures view{world_.name,
                           camera_.label,
                           light_.label,
                           camera_text(camera_),
                           light_text(light_),
                           {},
                           {},
                           {}};
        view.reference = write(picture_name({world_.name, place, lamp, "raytraced"}), reference);
        view.reference_detail = png_of(cropped(reference, corner, window, zoom));
        for (std::size_t i = first; i < all_.runs.size(); ++i) {
            run_record& run = all_.runs[i];
            run_pictures seen{i, {}, {}, {}, {}};
            const bool shown = is_shown(plan_[i - first]);
            if (shown) {
                const std::string map =
                    run.map == 0 ? std::string() : "m" + std::to_string(run.map) + "-";
                const auto name = [&](const std::string& kind) {
                    return picture_name(
                        {world_.name, place, lamp,
                         map + run.method + (run.bias ? "-" + *run.bias : std::string()) +
                             (run.raster ? "-" + *run.raster : std::string()) + kind});
                };
                const picture plain = run.result.light.empty() ? shade.shade(run.result.shadowed)
                                                               : shade.shade(run.result.light);
                picture marked = plain;
                paint_red(marked, run.against_truth.wrong);
                write(name(""), plain);
                seen.marked = write(name("-wrong"), marked);
                seen.detail = write(name("-detail"), cropped(plain, corner, window, zoom));
                seen.detail_marked =
                    write(name("-detail-wrong"), cropped(marked, corner, window, zoom));
                for (named_picture& each : run.result.pictures) {
                    png_file file = write(name(std::string("-") + each.name),
                                          {each.width, each.height, std::move(each.rgb)});
                    seen.explanations.emplace_back(each.name, std::move(file));
                }
            }
            if (shown || wanted_.pictured == 0 || run.map == 0) {
                view.runs.push_back(std::move(seen));
            }
            // one value per pixel, which nothing needs any more
            run.result.pictures.clear();
            run.result.shadowed = {};
            run.result.biases = {};
            run.result.light = {};
            run.against_truth.wrong = {};
        }
        return view;
    }

    png_file write(const std::string& name, const picture& source) {
        png_file file = png_of(source);
        folder_.write(name, file.bytes);
        return file;
    }

    const options& wanted_;
    const scene& world_;
    renderer& gpu_;
    const ray_tracer& rays_;
    const camera_view& camera_;
    const light_view& light_;
    results& all_;
    report_folder& folder_;
    progress_bar& progress_;
    g_buffer_samples samples_;
    traced_shadows truth_;
    std::vector<planned_run> plan_;
    std::vector<std::shared_ptr<standing_view>> standing_; ///< of each run, or null
    std::size_t standing_bytes_ = 0;
};

} // namespace

std::size_t steps_of_view(const options& wanted) {
    return (wanted.methods.size() * wanted.maps.size() *
                std::max<std::size_t>(wanted.biases.size(), 1) *
                std::max<std::size_t>(wanted.rasters.size(), 1) +
            wanted.variants.size()) *
           static_cast<std::size_t>(wanted.rounds);
}

view_pictures run_view(const options& wanted, const scene& world, renderer& gpu,
                       const ray_tracer& rays, const camera_view& camera, const light_view& light,
                       results& all, report_folder& folder, progress_bar& progress) {
    return view_runner(wanted, world, gpu, rays, camera, light, all, folder, progress).run();
}

} // namespace lab
