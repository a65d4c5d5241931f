// What accuracy costs in time: the runs of a report, set against each other.
#pragma once

#include "lab/results.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lab {

/// The method that others are set against: the plain maps for a kind of light.
inline std::string reference_for(std::string_view kind) {
    return kind == "point" ? "cube6" : "sm";
}

/// What a run is paid with.
enum class cost { time, bytes };

/// Milliseconds of the median frame, or bytes.
double cost_of(const run_record& run, cost of);

/// Share of wrong samples; nothing where no sample counts.
std::optional<double> wrong_of(const run_record& run);

/// Runs that no other one beats in wrong pixels without costing more, cheapest first.
///
/// Of equal runs the first stays.
/// @param which indices of runs of one view
std::vector<std::size_t> pareto_front(std::span<const run_record> runs,
                                      std::span<const std::size_t> which, cost of);

/// Indices of the runs of each scene, camera and light, in order of appearance.
std::vector<std::vector<std::size_t>> views_of(std::span<const run_record> runs);

/// A method at one map size over all views of one kind of light, as ratios to the reference at the
/// same size.
struct method_score {
    std::string kind; ///< of light
    std::string method;
    int map;
    std::size_t views;
    double wrong; ///< geometric mean of the ratios; half a sample stands for none
    double time;
    double bytes;
    std::size_t better; ///< views with fewer wrong pixels than the reference
    std::size_t worse;
};

/// Scores of all methods at all sizes; variants have theirs, see `score_variants`.
std::vector<method_score> score_methods(std::span<const run_record> runs);

/// A method with one thing changed, over all views, as ratios to the same method without.
struct variant_score {
    std::string method;
    std::string variant;
    std::size_t views;
    double wrong; ///< geometric mean of the ratios; of filtered shadows, where there is a filter
    double time;
    double bytes;
    double set_up; ///< time on the host, all its parts together
    /// Mean error of the filtered light; without a filter that is the share of wrong samples.
    std::optional<double> light_error;
};

/// Scores of all variants, in order of appearance.
std::vector<variant_score> score_variants(std::span<const run_record> runs);

/// The run of a method that matches one of another method.
struct matched_run {
    std::size_t target;             ///< index of the run to be matched
    std::string method;             ///< that is to match it
    std::optional<std::size_t> run; ///< its run that does; nothing: none of its sizes
};

/// For each view and each run of `targets` at `map`: the cheapest run of every other method with
/// maps that has no more wrong pixels.
std::vector<matched_run> match_quality(std::span<const run_record> runs,
                                       std::span<const std::string> targets, int map);

/// For each view and each run of `targets` at `map`: the run of every other method with maps that
/// has the fewest wrong pixels among those whose frame takes no longer; of equal ones the cheapest.
std::vector<matched_run> match_time(std::span<const run_record> runs,
                                    std::span<const std::string> targets, int map);

/// Share of wrong samples of a run to that of another; half a sample stands for none. Both have
/// samples that count.
double wrong_ratio(const run_record& run, const run_record& to);

/// The best method for a budget, over all views of a scene and a kind of light.
struct budget_choice {
    std::string scene; ///< "all" for all scenes together, where there are several
    std::string kind;  ///< of light
    double budget;     ///< frame times of the reference at its size; infinity: any time
    std::string method;
    int map;
    double wrong; ///< geometric mean over the views
    double time;  ///< frame time to the reference's, geometric mean
};

/// For each scene, kind of light and budget, the method and size with the fewest wrong pixels among
/// those that ran on all its views and cost no more than the budget in the geometric mean.
///
/// Methods without a map are left out: they have no error to trade; and so are variants.
/// @param map size of the reference that budgets are multiples of
std::vector<budget_choice> choose_for_budgets(std::span<const run_record> runs, int map,
                                              std::span<const double> budgets);

} // namespace lab
