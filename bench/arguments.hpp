// Command lines of the benchmarks that have no options of their own.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace bench {

/// Ends the program, with its usage, at an option or at more than `most` values: a file by the name
/// of an option is nothing that anyone asked for.
/// @param usage what follows "usage: "
inline void expect_values(int argc, char** argv, int most, const char* usage) {
    bool help = false;
    bool wrong = argc - 1 > most;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        help = help || argument == "--help" || argument == "-h";
        wrong = wrong || argument.starts_with('-');
    }
    if (help || wrong) {
        std::fprintf(help ? stdout : stderr, "usage: %s\n", usage);
        std::exit(help ? 0 : 2);
    }
}

} // namespace bench
