#include "lab/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace lab {
namespace {

/// The share of wrong samples for ratios: half a sample stands for none.
std::optional<double> ratio_of(const run_record& run) {
    const comparison& c = run.against_truth;
    if (c.samples == 0) {
        return std::nullopt;
    }
    const auto wrong = static_cast<double>(c.false_shadow + c.false_light);
    return std::max(wrong, 0.5) / static_cast<double>(c.samples);
}

/// Mean of logarithms, grown number by number.
struct geometric_mean {
    double logarithms = 0.0;
    std::size_t count = 0;

    void add(double value) {
        logarithms += std::log(value);
        ++count;
    }
    [[nodiscard]] double value() const {
        return count == 0 ? 0.0 : std::exp(logarithms / static_cast<double>(count));
    }
};

bool of_method(const run_record& run, const std::string& method, int map) {
    return run.method == method && run.map == map && !run.bias && !run.raster && !run.variant;
}

std::optional<std::size_t> find_run(std::span<const run_record> runs,
                                    const std::vector<std::size_t>& view, const std::string& method,
                                    int map) {
    const auto found = std::find_if(view.begin(), view.end(),
                                    [&](std::size_t i) { return of_method(runs[i], method, map); });
    return found == view.end() ? std::nullopt : std::optional(*found);
}

/// Microseconds on the host, all parts together.
double set_up_us(const run_record& run) {
    return std::accumulate(run.result.cpu_setup_us.begin(), run.result.cpu_setup_us.end(), 0.0,
                           [](double sum, const auto& part) { return sum + part.second; });
}

/// For each view and each run of `targets` at `map`: of the runs of every other method with maps,
/// those that match it, and of those the one with the least rank.
template <typename Matches, typename Rank>
std::vector<matched_run> match(std::span<const run_record> runs,
                               std::span<const std::string> targets, int map, Matches matches,
                               Rank rank) {
    std::vector<matched_run> result;
    for (const std::vector<std::size_t>& view : views_of(runs)) {
        for (const std::string& name : targets) {
            const std::optional<std::size_t> target = find_run(runs, view, name, map);
            if (!target || !wrong_of(runs[*target])) {
                continue;
            }
            const std::size_t first = result.size();
            for (const std::size_t i : view) {
                const run_record& run = runs[i];
                if (run.map == 0 || run.variant || run.method == name) {
                    continue;
                }
                const std::string text = method_text(run);
                auto entry =
                    std::find_if(result.begin() + static_cast<std::ptrdiff_t>(first), result.end(),
                                 [&](const matched_run& each) { return each.method == text; });
                if (entry == result.end()) {
                    entry = result.insert(result.end(), {*target, text, std::nullopt});
                }
                if (matches(run, runs[*target]) &&
                    (!entry->run || rank(run) < rank(runs[*entry->run]))) {
                    entry->run = i;
                }
            }
        }
    }
    return result;
}

/// What all kinds of scores have a mean of.
struct mean_ratios {
    geometric_mean wrong, time, bytes;

    void add_costs(const run_record& run, const run_record& to) {
        time.add(cost_of(run, cost::time) / cost_of(to, cost::time));
        bytes.add(cost_of(run, cost::bytes) / cost_of(to, cost::bytes));
    }
    template <typename Score> void write_to(Score& score) const {
        score.views = wrong.count;
        score.wrong = wrong.value();
        score.time = time.value();
        score.bytes = bytes.value();
    }
};

} // namespace

double cost_of(const run_record& run, cost of) {
    return of == cost::time ? run.result.frame_ms_median : static_cast<double>(run.result.bytes);
}

std::optional<double> wrong_of(const run_record& run) {
    return run.against_truth.ratio(run.against_truth.false_shadow + run.against_truth.false_light);
}

std::vector<std::size_t> pareto_front(std::span<const run_record> runs,
                                      std::span<const std::size_t> which, cost of) {
    std::vector<std::size_t> sorted;
    std::copy_if(which.begin(), which.end(), std::back_inserter(sorted),
                 [&](std::size_t i) { return wrong_of(runs[i]).has_value(); });
    std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(cost_of(runs[a], of), *wrong_of(runs[a])) <
               std::pair(cost_of(runs[b], of), *wrong_of(runs[b]));
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : sorted) {
        if (front.empty() || *wrong_of(runs[i]) < *wrong_of(runs[front.back()])) {
            front.push_back(i);
        }
    }
    return front;
}

std::vector<std::vector<std::size_t>> views_of(std::span<const run_record> runs) {
    std::vector<std::vector<std::size_t>> views;
    std::map<std::tuple<std::string, std::string, std::string>, std::size_t> known;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const auto [place, fresh] =
            known.try_emplace({runs[i].scene, runs[i].camera, runs[i].light}, views.size());
        if (fresh) {
            views.emplace_back();
        }
        views[place->second].push_back(i);
    }
    return views;
}

std::vector<method_score> score_methods(std::span<const run_record> runs) {
    struct sums : mean_ratios {
        std::size_t better = 0;
        std::size_t worse = 0;
    };
    std::vector<std::pair<method_score, sums>> scores;
    for (const std::vector<std::size_t>& view : views_of(runs)) {
        for (const std::size_t i : view) {
            const run_record& run = runs[i];
            const std::optional<std::size_t> base =
                find_run(runs, view, reference_for(run.kind), run.map);
            if (!base || run.variant || !ratio_of(run)) {
                continue;
            }
            const run_record& other = runs[*base];
            const std::string name = method_text(run);
            auto found = std::find_if(scores.begin(), scores.end(), [&](const auto& each) {
                return each.first.kind == run.kind && each.first.method == name &&
                       each.first.map == run.map;
            });
            if (found == scores.end()) {
                scores.push_back({{run.kind, name, run.map, 0, 0.0, 0.0, 0.0, 0, 0}, {}});
                found = std::prev(scores.end());
            }
            sums& sum = found->second;
            sum.wrong.add(wrong_ratio(run, other));
            sum.add_costs(run, other);
            sum.better += *wrong_of(run) < *wrong_of(other) ? 1u : 0u;
            sum.worse += *wrong_of(run) > *wrong_of(other) ? 1u : 0u;
        }
    }
    std::vector<method_score> result;
    for (const auto& [score, sum] : scores) {
        result.push_back(score);
        sum.write_to(result.back());
        result.back().better = sum.better;
        result.back().worse = sum.worse;
    }
    return result;
}

std::vector<variant_score> score_variants(std::span<const run_record> runs) {
    struct sums : mean_ratios {
        geometric_mean set_up, light_error;
    };
    std::vector<std::pair<variant_score, sums>> scores;
    for (const std::vector<std::size_t>& view : views_of(runs)) {
        for (const std::size_t i : view) {
            const run_record& run = runs[i];
            const std::optional<std::size_t> base = find_run(runs, view, run.method, run.map);
            if (!run.variant || !base || !ratio_of(run)) {
                continue;
            }
            const run_record& usual = runs[*base];
            auto found = std::find_if(scores.begin(), scores.end(), [&](const auto& each) {
                return each.first.method == run.method && each.first.variant == *run.variant;
            });
            if (found == scores.end()) {
                found = scores.insert(scores.end(),
                                      {{run.method, *run.variant, 0, 0.0, 0.0, 0.0, 0.0, {}}, {}});
            }
            const double none = 0.5 / static_cast<double>(run.against_truth.samples);
            sums& sum = found->second;
            sum.wrong.add(run.filtered.wrong
                              ? std::max(*run.filtered.wrong, none) / *ratio_of(usual)
                              : wrong_ratio(run, usual));
            if (run.filtered.mean_light) {
                sum.light_error.add(std::max(*run.filtered.mean_light, none) / *ratio_of(usual));
            }
            sum.add_costs(run, usual);
            if (set_up_us(run) > 0.0 && set_up_us(usual) > 0.0) {
                sum.set_up.add(set_up_us(run) / set_up_us(usual));
            }
        }
    }
    std::vector<variant_score> result;
    for (const auto& [score, sum] : scores) {
        result.push_back(score);
        sum.write_to(result.back());
        result.back().set_up = sum.set_up.value();
        if (sum.light_error.count > 0) {
            result.back().light_error = sum.light_error.value();
        }
    }
    return result;
}

double wrong_ratio(const run_record& run, const run_record& to) {
    return *ratio_of(run) / *ratio_of(to);
}

std::vector<matched_run> match_quality(std::span<const run_record> runs,
                                       std::span<const std::string> targets, int map) {
    return match(
        runs, targets, map,
        [](const run_record& run, const run_record& target) {
            return *wrong_of(run) <= *wrong_of(target);
        },
        [](const run_record& run) { return cost_of(run, cost::time); });
}

std::vector<matched_run> match_time(std::span<const run_record> runs,
                                    std::span<const std::string> targets, int map) {
    return match(
        runs, targets, map,
        [](const run_record& run, const run_record& target) {
            return cost_of(run, cost::time) <= cost_of(target, cost::time);
        },
        [](const run_record& run) { return std::pair(*wrong_of(run), cost_of(run, cost::time)); });
}

std::vector<budget_choice> choose_for_budgets(std::span<const run_record> runs, int map,
                                              std::span<const double> budgets) {
    struct candidate {
        std::string method;
        int map;
        geometric_mean wrong, time;
    };
    // per scene and kind of light, and over all scenes
    std::vector<std::pair<std::string, std::string>> groups;
    std::map<std::pair<std::string, std::string>, std::vector<candidate>> candidates;
    std::map<std::pair<std::string, std::string>, std::size_t> views;
    for (const std::vector<std::size_t>& view : views_of(runs)) {
        const std::optional<std::size_t> base =
            find_run(runs, view, reference_for(runs[view.front()].kind), map);
        if (!base || !ratio_of(runs[*base])) {
            continue;
        }
        for (const std::string& scene : {runs[*base].scene, std::string("all")}) {
            const std::pair group(scene, runs[*base].kind);
            if (views[group]++ == 0) {
                groups.push_back(group);
            }
            for (const std::size_t i : view) {
                const run_record& run = runs[i];
                if (run.map == 0 || run.variant) {
                    continue;
                }
                std::vector<candidate>& all = candidates[group];
                const std::string text = method_text(run);
                auto found = std::find_if(all.begin(), all.end(), [&](const candidate& each) {
                    return each.method == text && each.map == run.map;
                });
                if (found == all.end()) {
                    all.push_back({text, run.map, {}, {}});
                    found = std::prev(all.end());
                }
                found->wrong.add(*ratio_of(run));
                found->time.add(cost_of(run, cost::time) / cost_of(runs[*base], cost::time));
            }
        }
    }
    // scenes in order of appearance, all together last, and of one scene not at all
    const auto together = std::stable_partition(
        groups.begin(), groups.end(), [](const auto& group) { return group.first != "all"; });
    const auto alone = [&](const auto& all) {
        return std::count_if(groups.begin(), together,
                             [&](const auto& group) { return group.second == all.second; }) == 1;
    };
    groups.erase(std::remove_if(together, groups.end(), alone), groups.end());
    std::vector<budget_choice> result;
    for (const auto& group : groups) {
        for (const double budget : budgets) {
            const candidate* best = nullptr;
            for (const candidate& each : candidates[group]) {
                if (each.wrong.count == views[group] && each.time.value() <= budget &&
                    (best == nullptr || each.wrong.value() < best->wrong.value())) {
                    best = &each;
                }
            }
            if (best != nullptr) {
                result.push_back({group.first, group.second, budget, best->method, best->map,
                                  best->wrong.value(), best->time.value()});
            }
        }
    }
    return result;
}

} // namespace lab
