// What accuracy costs in time: error and nanoseconds of every numeric kernel in every variant.
//
// arithmetic [FILE.json [ROUNDS]]: JSON to the file, or to the standard output; ROUNDS rounds of
// timing (15 if it is not given). Errors are against a 100-digit oracle over fixed random inputs;
// all variants of all kernels take turns in each round, so that a drift of the machine meets all.
#include "../arguments.hpp"
#include "describe.hpp"
#include "measure.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace arithmetic;

#if defined(__clang__)
constexpr const char* compiler = __VERSION__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("model name", 0) == 0) {
            return line.substr(line.find(": ") + 2);
        }
    }
    return "unknown processor";
}

double seconds(const entry& each, int repeats) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < repeats; ++i) {
        each.round();
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    return taken.count();
}

/// Four digits are more than a time or an error is good for.
nlohmann::json rounded(double x) {
    if (!std::isfinite(x)) {
        return nullptr;
    }
    if (x == 0.0) {
        return 0.0;
    }
    const double scale = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(x))));
    return std::stod(nlohmann::json(std::round(x * scale) / scale).dump());
}

nlohmann::json timed(std::vector<double> ns) {
    std::sort(ns.begin(), ns.end());
    return {{"fastest", rounded(ns.front())}, {"median", rounded(ns[ns.size() / 2])}};
}

nlohmann::json judged(const std::vector<double>& errors, bool decisions) {
    nlohmann::json result = {{"inputs", errors.size()}};
    const auto share = [&](double what) {
        return rounded(1e6 * static_cast<double>(std::count(errors.begin(), errors.end(), what)) /
                       static_cast<double>(errors.size()));
    };
    if (decisions) {
        result["missed_per_million"] = share(missed);
        result["in_vain_per_million"] = share(kept_in_vain);
        return result;
    }
    std::vector<double> sizes;
    std::size_t undefined = 0;
    for (const double e : errors) {
        if (std::isfinite(e)) {
            sizes.push_back(std::abs(e));
        } else {
            ++undefined;
        }
    }
    std::sort(sizes.begin(), sizes.end());
    // results that are NaN or infinite are the worst of all; of few results it is the largest
    const auto at =
        static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(errors.size() - 1)));
    result["p999"] = at < sizes.size() ? rounded(sizes[at]) : nlohmann::json(nullptr);
    result["largest"] = undefined == 0 ? rounded(sizes.back()) : nlohmann::json(nullptr);
    result["undefined"] = undefined;
    return result;
}

} // namespace

int main(int argc, char** argv) {
    bench::expect_values(argc, argv, 2, "arithmetic [FILE.json [ROUNDS]]");
    const int rounds = argc > 2 ? std::max(std::atoi(argv[2]), 1) : 15;
    entries all;
    portable::add_kernels(all);
    native::add_kernels(all);

    constexpr double least = 2e-4; // seconds: a clock cannot be the error
    std::vector<int> repeats;
    for (const entry& each : all.all()) {
        const double once = seconds(each, 1); // and the results to be judged
        repeats.push_back(once > least ? 1 : static_cast<int>(least / std::max(once, 1e-7)) + 1);
    }
    std::vector<std::vector<double>> ns(all.all().size());
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < ns.size(); ++i) {
            const entry& each = all.all()[i];
            each.round(); // so that no variant pays for what the one before it has displaced
            ns[i].push_back(1e9 * seconds(each, repeats[i]) / (repeats[i] * each.calls));
        }
    }

    nlohmann::json builds = nlohmann::json::array();
    for (const build& each : all.builds()) {
        builds.push_back({{"flags", each.flags}, {"doubles_at_once", each.lanes}});
    }
    nlohmann::json kernels = nlohmann::json::array();
    for (const kernel_description& kernel : describe()) {
        nlohmann::json envelopes = nlohmann::json::array();
        for (const auto& [name, text] : kernel.envelopes) {
            envelopes.push_back({{"name", name}, {"text", text}});
        }
        nlohmann::json rows = nlohmann::json::array();
        for (std::size_t i = 0; i < ns.size(); ++i) {
            const entry& each = all.all()[i];
            if (each.kernel == kernel.name) {
                nlohmann::json row = judged(each.errors(), kernel.decisions);
                row["envelope"] = each.envelope;
                row["variant"] = each.variant;
                row["build"] = each.build;
                row["ns"] = timed(ns[i]);
                rows.push_back(row);
            }
        }
        kernels.push_back({{"name", kernel.name},
                           {"what", kernel.what},
                           {"unit", kernel.unit},
                           {"per", kernel.per},
                           {"decisions", kernel.decisions},
                           {"envelopes", envelopes},
                           {"rows", rows}});
    }
    const nlohmann::json json = {
        {"schema", 1},      {"processor", processor()}, {"compiler", compiler}, {"builds", builds},
        {"rounds", rounds}, {"map", map_size},          {"kernels", kernels}};
    if (argc > 1) {
        std::ofstream(argv[1]) << json.dump(1) << '\n';
    } else {
        std::cout << json.dump(1) << '\n';
    }
    return 0;
}
