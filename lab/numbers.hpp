// Numbers and lists in the texts of a command line.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace lab {

/// The parts between separators; as many as there are, and one.
inline std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = text.find(separator, begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string::npos) {
            return parts;
        }
        begin = end + 1;
    }
}

/// A number that is all of a text; nothing for any other text.
template <typename T> std::optional<T> number(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
    }
    T value{};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc() || rest != end) {
        return std::nullopt;
    }
    return value;
}

/// The same where it is from `least` to `largest`; NaN is nowhere.
template <typename T> std::optional<T> number_in(std::string_view text, T least, T largest) {
    const std::optional<T> value = number<T>(text);
    return value && *value >= least && *value <= largest ? value : std::nullopt;
}

} // namespace lab
