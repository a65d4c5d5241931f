// What a sweep makes of its runs: fronts, scores, equal quality, budgets; and archives of views.
#include "lab/accuracy.hpp"
#include "lab/sweep.hpp"
#include "lab/view_archive.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>

namespace {

/// A run with so many of 1000 samples wrong.
lab::run_record run_of(const std::string& scene, const std::string& method, int map,
                       std::size_t wrong, double ms, std::size_t bytes = 1) {
    lab::run_record run{};
    run.scene = scene;
    run.camera = "0";
    run.light = "0";
    run.method = method;
    run.map = map;
    run.against_truth.samples = 1000;
    run.against_truth.false_light = wrong;
    lab::add_times(run.result, std::vector<double>{ms});
    run.result.bytes = bytes;
    return run;
}

std::vector<std::size_t> all_of(const std::vector<lab::run_record>& runs) {
    std::vector<std::size_t> which(runs.size());
    std::iota(which.begin(), which.end(), std::size_t(0));
    return which;
}

bool beats(const lab::run_record& a, const lab::run_record& b, lab::cost of) {
    return lab::cost_of(a, of) <= lab::cost_of(b, of) && *lab::wrong_of(a) <= *lab::wrong_of(b) &&
           (lab::cost_of(a, of) < lab::cost_of(b, of) || *lab::wrong_of(a) < *lab::wrong_of(b));
}

} // namespace

TEST_CASE("front: nobody on it is beaten, everybody else is, or is equal to one on it") {
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        std::vector<lab::run_record> runs;
        std::uniform_int_distribution<int> count(0, 20);
        std::uniform_int_distribution<int> value(1, 12);
        for (int i = count(random); i > 0; --i) {
            runs.push_back(run_of("a", "sm", 512, static_cast<std::size_t>(value(random)),
                                  value(random), static_cast<std::size_t>(value(random))));
        }
        for (const lab::cost of : {lab::cost::time, lab::cost::bytes}) {
            const std::vector<std::size_t> front = lab::pareto_front(runs, all_of(runs), of);
            for (std::size_t i = 0; i < runs.size(); ++i) {
                const bool on = std::find(front.begin(), front.end(), i) != front.end();
                const bool beaten = std::any_of(runs.begin(), runs.end(), [&](const auto& other) {
                    return beats(other, runs[i], of);
                });
                const bool twin = std::any_of(front.begin(), front.end(), [&](std::size_t j) {
                    return j != i && !beats(runs[j], runs[i], of) && !beats(runs[i], runs[j], of) &&
                           lab::cost_of(runs[j], of) == lab::cost_of(runs[i], of);
                });
                REQUIRE(on == (!beaten && !twin));
            }
        }
    }
}

TEST_CASE("front: a run without samples is not on it") {
    std::vector<lab::run_record> runs{run_of("a", "sm", 512, 10, 1.0)};
    runs.front().against_truth.samples = 0;
    REQUIRE(lab::pareto_front(runs, all_of(runs), lab::cost::time).empty());
    REQUIRE(lab::score_methods(runs).empty());
    REQUIRE(lab::match_quality(runs, std::vector<std::string>{"sm"}, 512).empty());
    REQUIRE(lab::match_time(runs, std::vector<std::string>{"sm"}, 512).empty());
    REQUIRE(lab::choose_for_budgets(runs, 512, std::vector<double>{1.0}).empty());
}

TEST_CASE("scores: geometric means of ratios at equal sizes") {
    const std::vector<lab::run_record> runs{
        run_of("a", "sm", 512, 100, 1.0, 10), run_of("a", "dv", 512, 50, 2.0, 10),
        run_of("b", "sm", 512, 10, 4.0, 10), run_of("b", "dv", 512, 20, 4.0, 40),
        run_of("b", "dv", 256, 40, 3.0, 40)};
    const std::vector<lab::method_score> scores = lab::score_methods(runs);
    REQUIRE(scores.size() == 2); // nothing to compare dv at 256 with
    REQUIRE(scores[0].method == "sm");
    REQUIRE(scores[0].wrong == Approx(1.0));
    REQUIRE(scores[1].views == 2);
    REQUIRE(scores[1].wrong == Approx(1.0)); // half and double
    REQUIRE(scores[1].time == Approx(std::sqrt(2.0)));
    REQUIRE(scores[1].bytes == Approx(2.0));
    REQUIRE((scores[1].better == 1 && scores[1].worse == 1));
}

TEST_CASE("variants: ratios to the same method without, and no part in scores and budgets") {
    std::vector<lab::run_record> runs{
        run_of("a", "sm", 512, 100, 1.0),  run_of("a", "notw", 512, 20, 4.0),
        run_of("a", "notw", 512, 10, 1.0), run_of("a", "notw", 512, 20, 8.0),
        run_of("b", "sm", 512, 100, 1.0),  run_of("b", "notw", 512, 20, 4.0),
        run_of("b", "notw", 512, 40, 1.0)};
    for (const std::size_t i : {std::size_t(2), std::size_t(6)}) {
        runs[i].variant = "tables 32";
        runs[i].result.cpu_setup_us = {{"light matrix", 3.0}, {"fit", 5.0}};
    }
    runs[1].result.cpu_setup_us = runs[5].result.cpu_setup_us = {{"light matrix", 4.0}};
    runs[3].variant = "filter pcf";
    runs[3].filtered = {0.03, 0.01};
    const std::vector<lab::variant_score> scores = lab::score_variants(runs);
    REQUIRE(scores.size() == 2);
    REQUIRE((scores[0].method == "notw" && scores[0].variant == "tables 32"));
    REQUIRE(scores[0].views == 2);
    REQUIRE(scores[0].wrong == Approx(1.0)); // half and double
    REQUIRE(scores[0].time == Approx(0.25));
    REQUIRE(scores[0].set_up == Approx(2.0));
    REQUIRE_FALSE(scores[0].light_error);
    REQUIRE(scores[1].wrong == Approx(0.5)); // of the filtered shadows
    REQUIRE(*scores[1].light_error == Approx(1.5));
    REQUIRE(lab::score_methods(runs).size() == 2);
    for (const lab::budget_choice& each :
         lab::choose_for_budgets(runs, 512, std::vector<double>{1.0, 100.0})) {
        REQUIRE(each.method == (each.budget == 1.0 ? "sm" : "notw"));
    }
}

TEST_CASE("equal quality: the cheapest size that has no more wrong pixels, or none") {
    const std::vector<lab::run_record> runs{
        run_of("a", "notw", 512, 20, 5.0), run_of("a", "sm", 256, 100, 1.0),
        run_of("a", "sm", 1024, 20, 3.0),  run_of("a", "sm", 2048, 10, 9.0),
        run_of("a", "dv", 512, 30, 1.0),   run_of("a", "raytraced", 0, 0, 1.0)};
    const std::vector<lab::matched_run> rows =
        lab::match_quality(runs, std::vector<std::string>{"notw", "absent"}, 512);
    REQUIRE(rows.size() == 2);
    REQUIRE((rows[0].method == "sm" && rows[0].run == std::size_t(2) && rows[0].target == 0));
    REQUIRE((rows[1].method == "dv" && !rows[1].run));
}

TEST_CASE("equal time: no run that fits the target's frame has fewer wrong pixels") {
    std::mt19937 random(2);
    std::uniform_int_distribution<int> value(0, 12);
    const std::vector<std::string> methods{"sm", "dv", "notw"};
    const std::vector<std::string> targets{"notw", "sm"};
    std::size_t found = 0;
    std::size_t missed = 0;
    for (int round = 0; round < 200; ++round) {
        std::vector<lab::run_record> runs;
        for (const std::string scene : {"a", "b"}) {
            for (const std::string& method : methods) {
                for (const int map : {256, 512, 1024}) {
                    runs.push_back(run_of(scene, method, map,
                                          static_cast<std::size_t>(value(random)),
                                          1.0 + value(random)));
                }
            }
            runs.push_back(run_of(scene, "raytraced", 0, 0, 0.5)); // has no map to choose
            runs.push_back(run_of(scene, "dv", 512, 0, 0.5));      // no method, but a variant
            runs.back().variant = "other tables";
        }
        const std::vector<lab::matched_run> rows = lab::match_time(runs, targets, 512);
        REQUIRE(rows.size() == 2 * targets.size() * (methods.size() - 1));
        for (const lab::matched_run& row : rows) {
            const lab::run_record& target = runs[row.target];
            REQUIRE(target.map == 512);
            REQUIRE(row.method != target.method);
            std::optional<std::size_t> least; // of wrong samples, by trying all
            for (const lab::run_record& run : runs) {
                if (run.scene == target.scene && run.method == row.method && !run.variant &&
                    run.result.frame_ms_median <= target.result.frame_ms_median) {
                    const std::size_t wrong = run.against_truth.false_light;
                    least = least ? std::min(*least, wrong) : wrong;
                }
            }
            REQUIRE(row.run.has_value() == least.has_value());
            if (!row.run) {
                ++missed;
                continue;
            }
            ++found;
            const lab::run_record& run = runs[*row.run];
            REQUIRE((run.scene == target.scene && run.method == row.method && !run.variant));
            REQUIRE(run.result.frame_ms_median <= target.result.frame_ms_median);
            REQUIRE(run.against_truth.false_light == *least);
            const double none = 0.5; // stands for no wrong sample
            REQUIRE(lab::wrong_ratio(run, target) ==
                    Approx(std::max(static_cast<double>(*least), none) /
                           std::max(static_cast<double>(target.against_truth.false_light), none)));
        }
    }
    REQUIRE(found > 100);
    REQUIRE(missed > 100);
}

TEST_CASE("budgets: the least error that the time allows, on all views of the scene") {
    const std::vector<lab::run_record> runs{
        run_of("a", "sm", 512, 100, 1.0),  run_of("a", "dv", 512, 50, 1.4),
        run_of("a", "notw", 512, 10, 3.0), run_of("a", "raytraced", 0, 0, 0.1),
        run_of("b", "sm", 512, 100, 1.0),  run_of("b", "dv", 512, 90, 1.4)};
    const double any = std::numeric_limits<double>::infinity();
    const std::vector<double> budgets{0.5, 1.0, 1.5, any};
    const std::vector<lab::budget_choice> rows = lab::choose_for_budgets(runs, 512, budgets);
    // nothing at half the time; a, b, and both, where notw did not run everywhere
    REQUIRE(rows.size() == 9);
    const auto at = [&](std::size_t i) { return rows[i].scene + " " + rows[i].method; };
    REQUIRE((at(0) == "a sm" && at(1) == "a dv" && at(2) == "a notw"));
    REQUIRE((at(3) == "b sm" && at(4) == "b dv" && at(5) == "b dv"));
    REQUIRE((at(6) == "all sm" && at(7) == "all dv" && at(8) == "all dv"));
    REQUIRE(rows[7].wrong == Approx(std::sqrt(0.05 * 0.09)));
    REQUIRE(rows[7].time == Approx(1.4));
}

TEST_CASE("archives: what goes in comes out, and nothing of other settings or broken bytes") {
    lab::archived_view view{};
    lab::run_record run = run_of("a", "notw", 512, 20, 5.0, 77);
    run.kind = "spot";
    run.variant = "tables 32";
    run.filter = "pcf-texels:2";
    run.filtered = {0.125, 0.0625};
    run.tables = "unorm16";
    run.set_up = "float";
    run.result.weakened = 0.25;
    run.result.passes = {{"shadow map", 1.5}};
    run.result.cpu_setup_us = {{"light matrix", 0.5}};
    run.result.status = {"unbounded"};
    run.result.texels.emplace();
    run.result.texels->facing.p99 = 3.0;
    view.runs.push_back(run);
    view.pictures.scene = "a";
    view.pictures.reference = {2, 1, {1, 2, 3}};
    view.pictures.runs.push_back({0, {1, 1, {9}}, {}, {}, {{"counts", {1, 2, {4, 5}}}}});
    const std::vector<std::uint8_t> bytes = lab::archive_of(view, "settings");
    const std::optional<lab::archived_view> back = lab::read_archive(bytes, "settings");
    REQUIRE(back);
    lab::results before;
    before.runs = view.runs;
    lab::results after;
    after.runs = back->runs;
    REQUIRE(lab::json_of(before) == lab::json_of(after));
    REQUIRE(back->pictures.reference.bytes == std::vector<std::uint8_t>{1, 2, 3});
    REQUIRE(back->pictures.runs.at(0).explanations.at(0).first == "counts");
    REQUIRE(back->pictures.runs.at(0).explanations.at(0).second.height == 2);
    REQUIRE_FALSE(lab::read_archive(bytes, "others"));
    REQUIRE_FALSE(lab::read_archive({}, "settings"));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        REQUIRE_FALSE(lab::read_archive(std::span(bytes).first(size), "settings"));
    }
}

TEST_CASE("archives of paths: what goes in comes out, and nothing of broken bytes") {
    const std::vector<lab::path_record> paths{
        {"a", "0", "1", "yaw", "dv", 512, {{0.25, std::nullopt, 0.5, 3.0, 1.0, 1}}},
        {"a", "0", "1", "yaw", "sm", 512, {{std::nullopt, 0.125, 0.0, 4.0, 2.0, 6}}}};
    const std::vector<std::uint8_t> bytes = lab::archive_of(std::span(paths), "settings");
    const auto back = lab::read_path_archive(bytes, "settings");
    REQUIRE(back);
    lab::results before;
    before.paths = paths;
    lab::results after;
    after.paths = *back;
    REQUIRE(lab::json_of(before) == lab::json_of(after));
    REQUIRE_FALSE(lab::read_path_archive(bytes, "others"));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        REQUIRE_FALSE(lab::read_path_archive(std::span(bytes).first(size), "settings"));
    }
}

TEST_CASE("sweeps: variants and moves are of the methods that the sweep runs, and of its light") {
    lab::options wanted = lab::options_of_sweep("short");
    wanted.methods = {"notw", "sm", "stable", "sdsm"};
    wanted.maps = {64, 256};
    lab::settle_sweep(wanted);
    const lab::light_view sun{"sun", warpshadow::sun(glm::dvec3(0.0, -1.0, 0.0))};
    const auto moves = lab::options_of_motion(wanted, sun);
    REQUIRE(moves);
    REQUIRE(moves->methods == std::vector<std::string>{"sm", "stable", "notw"});
    REQUIRE(moves->maps == std::vector<int>{64});
    REQUIRE(moves->path == "yaw");
    REQUIRE(moves->variants.empty());
    REQUIRE_FALSE(wanted.variants.empty());
    for (const lab::run_variant& variant : wanted.variants) {
        REQUIRE((variant.method == "notw" || variant.method == "sm" || variant.method == "stable"));
        REQUIRE(variant.map == 64);
    }
    const lab::light_view lamp{"lamp", warpshadow::point_light(glm::dvec3(0.0))};
    REQUIRE_FALSE(lab::options_of_motion(wanted, lamp));
    REQUIRE_FALSE(lab::options_of_motion(lab::options{}, sun));
}

TEST_CASE("sweeps: both name methods and sizes, and nothing else is a sweep") {
    REQUIRE(lab::options_of_sweep("short").rounds > 1);
    REQUIRE(lab::options_of_sweep("full").maps.size() > lab::options_of_sweep("short").maps.size());
    REQUIRE_THROWS_AS(lab::options_of_sweep("long"), lab::bad_input);
    lab::options wanted;
    wanted.maps = {256, 512};
    REQUIRE(lab::pictured_size(wanted) == 512);
    wanted.maps = {256, 64};
    REQUIRE(lab::pictured_size(wanted) == 64);
}
