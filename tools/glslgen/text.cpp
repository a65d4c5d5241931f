#include "text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>

namespace glslgen {
namespace {

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// Where a line may be broken: the first character of the next line, how deep in brackets it is, and
// how much the place is liked (less is better).
struct break_point {
    std::size_t at;
    std::size_t depth;
    int strength;
};

int operator_strength(std::string_view op) {
    constexpr std::array<std::pair<std::string_view, int>, 15> levels{{{"||", 3},
                                                                       {"&&", 4},
                                                                       {"|", 5},
                                                                       {"^", 5},
                                                                       {"&", 5},
                                                                       {"==", 6},
                                                                       {"!=", 6},
                                                                       {"<", 7},
                                                                       {">", 7},
                                                                       {"<=", 7},
                                                                       {">=", 7},
                                                                       {"+", 8},
                                                                       {"-", 8},
                                                                       {"*", 9},
                                                                       {"/", 9}}};
    for (const auto& [text, strength] : levels) {
        if (text == op) {
            return strength;
        }
    }
    return 0;
}

// A logical line that is cut as it is written.
class line_breaker {
  public:
    explicit line_breaker(std::string line) : line_(std::move(line)) {
        indent_ = line_.find_first_not_of(' ');
        at_ = indent_;
        // what goes on below stands under the beginning of the expression
        hang_ = indent_ + 4;
        constexpr std::string_view back = "return ";
        if (line_.compare(indent_, back.size(), back) == 0) {
            hang_ = indent_ + back.size();
        }
    }

    void append_to(std::vector<std::string>& lines) {
        while (indent_ + line_.size() - at_ > column_limit) {
            const std::optional<break_point> best = choose();
            if (!best) {
                break;
            }
            lines.push_back(std::string(indent_, ' ') + line_.substr(at_, best->at - 1 - at_));
            advance(best->at);
        }
        lines.push_back(std::string(indent_, ' ') + line_.substr(at_));
    }

  private:
    std::optional<break_point> choose() {
        std::optional<break_point> best;
        std::size_t depth = open_.size();
        for (std::size_t i = at_; i < line_.size() && indent_ + i - at_ <= column_limit; ++i) {
            const char c = line_[i];
            if (c == '(' || c == '[') {
                ++depth;
            } else if (c == ')' || c == ']') {
                --depth;
            } else if (c == ' ' && i > at_) {
                const int strength = strength_at(i);
                // very little on a line helps nobody
                const bool enough = i - at_ > 8;
                if (strength >= 0 && enough &&
                    (!best || depth < best->depth ||
                     (depth == best->depth && strength <= best->strength))) {
                    best = break_point{i + 1, depth, strength};
                }
            }
        }
        return best;
    }

    // Operators end a line, but for ? and :, which begin one.
    int strength_at(std::size_t space) {
        const std::size_t word = line_.rfind(' ', space - 1) + 1;
        const std::string_view before = std::string_view(line_).substr(word, space - word);
        const std::size_t next = std::min(line_.find(' ', space + 1), line_.size());
        const std::string_view after = std::string_view(line_).substr(space + 1, next - space - 1);
        if (!before.empty() && (before.back() == ',' || before.back() == ';')) {
            return 0;
        }
        if (after == "?" || after == ":") {
            return 2;
        }
        if (before == "=" || before == "+=" || before == "-=" || before == "*=" || before == "/=") {
            return 20; // rather anywhere else
        }
        const int strength = operator_strength(before);
        return strength == 0 ? -1 : strength;
    }

    void advance(std::size_t to) {
        for (std::size_t i = at_; i < to; ++i) {
            const std::size_t column = indent_ + i - at_;
            if (line_[i] == '(' || line_[i] == '[') {
                open_.push_back(column + 1);
            } else if ((line_[i] == ')' || line_[i] == ']') && !open_.empty()) {
                open_.pop_back();
            } else if (open_.empty() && !assigned_ && line_[i] == '=' && i > 0 &&
                       line_[i + 1] == ' ' && (line_[i - 1] == ' ' || line_[i - 2] == ' ')) {
                assigned_ = true;
                // a break right after = hangs by four
                hang_ = i + 2 == to ? hang_ : column + 2;
            }
        }
        at_ = to;
        indent_ = open_.empty() ? hang_ : open_.back();
    }

    std::string line_;
    std::size_t at_ = 0;     // what is not written yet
    std::size_t indent_ = 0; // of the line that it begins
    std::size_t hang_ = 0;   // column of continuations outside brackets
    std::vector<std::size_t> open_;
    bool assigned_ = false;
};

} // namespace

void append_wrapped(std::vector<std::string>& lines, std::string line) {
    while (line.size() > column_limit) {
        const std::size_t indent = line.find_first_not_of(' ');
        const std::size_t comment = line.find("//");
        if (indent != std::string::npos && comment == indent) {
            // a comment goes on below, with the same mark
            const std::size_t mark = line.find(' ', indent);
            const std::size_t end = line.rfind(' ', column_limit);
            if (mark == std::string::npos || end == std::string::npos || end <= mark) {
                break;
            }
            lines.push_back(line.substr(0, end));
            line = line.substr(0, mark + 1) + line.substr(end + 1);
            continue;
        }
        if (indent != std::string::npos && comment == std::string::npos) {
            line_breaker(std::move(line)).append_to(lines);
            return;
        }
        break;
    }
    lines.push_back(std::move(line));
}

std::string to_ascii(std::string_view text) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 66> spellings{
        {{"−", "-"},        {"–", "-"},        {"—", "-"},       {"·", "*"},
         {"×", "x"},        {"≤", "<="},       {"≥", ">="},      {"≠", "!="},
         {"≈", "~"},        {"±", "+-"},       {"½", "1/2"},     {"¼", "1/4"},
         {"¾", "3/4"},      {"⁻", "^-"},       {"⁰", "^0"},      {"¹", "^1"},
         {"²", "^2"},       {"³", "^3"},       {"⁴", "^4"},      {"⁵", "^5"},
         {"⁶", "^6"},       {"⁷", "^7"},       {"⁸", "^8"},      {"⁹", "^9"},
         {"ᵀ", "^T"},       {"₀", "_0"},       {"₁", "_1"},      {"₂", "_2"},
         {"₃", "_3"},       {"₄", "_4"},       {"α", "alpha"},   {"β", "beta"},
         {"γ", "gamma"},    {"δ", "delta"},    {"ε", "epsilon"}, {"η", "eta"},
         {"θ", "theta"},    {"κ", "kappa"},    {"λ", "lambda"},  {"μ", "mu"},
         {"ν", "nu"},       {"π", "pi"},       {"ρ", "rho"},     {"σ", "sigma"},
         {"τ", "tau"},      {"φ", "phi"},      {"ψ", "psi"},     {"ω", "omega"},
         {"Δ", "Delta"},    {"Σ", "sum"},      {"∂", "d"},       {"∞", "infinity"},
         {"√", "sqrt"},     {"∫", "integral"}, {"∈", "in"},      {"∩", "intersect"},
         {"∪", "union"},    {"→", "->"},       {"⇒", "=>"},      {"°", " degrees"},
         {"§", "section "}, {"“", "\""},       {"”", "\""},      {"’", "'"},
         {"…", "..."},      {"⊥", "perp"}}};
    std::string result;
    std::string_view previous; // a run of superscripts is one exponent
    while (!text.empty()) {
        std::string_view taken = text.substr(0, 1);
        std::string_view spelled = taken;
        if (static_cast<unsigned char>(text[0]) >= 0x80) {
            for (const auto& [from, to] : spellings) {
                if (text.starts_with(from)) {
                    taken = from;
                    spelled = to;
                    break;
                }
            }
            if (spelled.size() > 1 && spelled[0] == '^' && previous.size() > 1 &&
                previous[0] == '^') {
                result += spelled.substr(1);
                previous = spelled;
                text.remove_prefix(taken.size());
                continue;
            }
        }
        result += spelled;
        previous = spelled;
        text.remove_prefix(taken.size());
    }
    return result;
}

std::string float_literal(float value) {
    std::array<char, 64> buffer{};
    const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    static_cast<void>(code);
    std::string text(buffer.data(), end);
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

std::uint64_t fnv1a(std::string_view text, std::uint64_t state) {
    for (const char c : text) {
        state ^= static_cast<unsigned char>(c);
        state *= 0x100000001b3u;
    }
    return state;
}

std::string upper(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](char c) {
        return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    });
    return result;
}

std::string with_prefix(std::string_view text, std::string_view prefix) {
    if (prefix == "ws_") {
        return std::string(text);
    }
    std::string result;
    const std::string macro = upper(prefix);
    for (std::size_t i = 0; i < text.size();) {
        if (!is_word(text[i])) {
            result += text[i++];
            continue;
        }
        std::size_t end = i;
        while (end < text.size() && is_word(text[end])) {
            ++end;
        }
        const std::string_view word = text.substr(i, end - i);
        if (word.starts_with("ws_")) {
            result += prefix;
            result += word.substr(3);
        } else if (word.starts_with("WS_")) {
            result += macro;
            result += word.substr(3);
        } else {
            result += word;
        }
        i = end;
    }
    return result;
}

std::string quoted(std::string_view text, std::string_view indent) {
    std::string result;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = text.substr(0, end);
        result += indent;
        result += '"';
        for (const char c : line) {
            if (c == '"' || c == '\\') {
                result += '\\';
            }
            result += c;
        }
        result += end == std::string_view::npos ? "\"\n" : "\\n\"\n";
        text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    }
    return result.empty() ? std::string(indent) + "\"\"\n" : result;
}

} // namespace glslgen
