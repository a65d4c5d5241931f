// Rewrites emitted GLSL as C++ on GLM, token by token, so that it can be replayed on the host.
//
//   glsl_to_cpp INPUT OUTPUT NAMESPACE [--replace FROM TO]...
//
// It knows nothing of the generator: it is given GLSL and keeps what GLSL means. `out` parameters
// begin with a poisoned value, since GLSL leaves them undefined. --replace plants a fault; FROM
// must be there.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

struct token {
    std::string text;
    std::string space; // what stood before it: blanks, comments, preprocessor lines
};

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::vector<token> tokens_of(const std::string& text) {
    std::vector<token> result;
    std::string space;
    std::size_t i = 0;
    while (i < text.size()) {
        const std::size_t begin = i;
        const bool line_start = begin == 0 || text[begin - 1] == '\n';
        if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
            space += text[i++];
        } else if (text.compare(i, 2, "//") == 0 || (line_start && text[i] == '#')) {
            i = std::min(text.find('\n', i), text.size());
            space += text.substr(begin, i - begin);
        } else {
            if (std::isdigit(static_cast<unsigned char>(text[i])) != 0) {
                // a number: digits, point, exponent with sign, suffix
                const bool hexadecimal = text.compare(i, 2, "0x") == 0;
                while (i < text.size() && (is_word(text[i]) || text[i] == '.' ||
                                           (!hexadecimal && (text[i] == '+' || text[i] == '-') &&
                                            (text[i - 1] == 'e' || text[i - 1] == 'E')))) {
                    ++i;
                }
            } else if (is_word(text[i])) {
                while (i < text.size() && is_word(text[i])) {
                    ++i;
                }
            } else {
                ++i;
            }
            result.push_back({text.substr(begin, i - begin), space});
            space.clear();
        }
    }
    result.push_back({"", space});
    return result;
}

bool is_name(const token& t) {
    return !t.text.empty() && is_word(t.text[0]) &&
           std::isdigit(static_cast<unsigned char>(t.text[0])) == 0;
}

bool is_float(const std::string& number) {
    return number.find_first_of(".eE") != std::string::npos && number.compare(0, 2, "0x") != 0;
}

class rewriter {
  public:
    explicit rewriter(std::vector<token> tokens) : tokens_(std::move(tokens)) {
        for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
            if (tokens_[i].text == "struct") {
                structs_.insert(tokens_[i + 1].text);
            }
        }
    }

    std::string run() {
        rewrite(0, tokens_.size());
        return out_;
    }

  private:
    void put(const std::string& space, const std::string& text) {
        out_ += space;
        out_ += text;
    }

    std::size_t closing(std::size_t open) const {
        const std::string& begin = tokens_[open].text;
        const std::string end = begin == "(" ? ")" : begin == "[" ? "]" : "}";
        int depth = 0;
        for (std::size_t i = open; i < tokens_.size(); ++i) {
            depth += tokens_[i].text == begin ? 1 : tokens_[i].text == end ? -1 : 0;
            if (depth == 0) {
                return i;
            }
        }
        std::cerr << "glsl_to_cpp: brackets do not match\n";
        std::exit(1);
    }

    // `type name [` or `type [`, both of which C++ writes as an array type.
    bool is_array(std::size_t i) const {
        if (!is_name(tokens_[i]) || i + 1 >= tokens_.size()) {
            return false;
        }
        const bool is_type =
            structs_.count(tokens_[i].text) != 0 || tokens_[i].text == "float" ||
            tokens_[i].text == "int" || tokens_[i].text == "uint" || tokens_[i].text == "bool" ||
            tokens_[i].text.rfind("vec", 0) == 0 || tokens_[i].text.rfind("ivec", 0) == 0 ||
            tokens_[i].text.rfind("uvec", 0) == 0 || tokens_[i].text.rfind("bvec", 0) == 0 ||
            tokens_[i].text.rfind("mat", 0) == 0;
        return is_type && (tokens_[i + 1].text == "[" ||
                           (is_name(tokens_[i + 1]) && tokens_[i + 2].text == "["));
    }

    void rewrite(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const token& t = tokens_[i];
            if (depth_ == 0 && is_function(i)) {
                i = function(i);
            } else if (t.text == "struct") {
                put(t.space, t.text);
            } else if (is_array(i)) {
                i = array(i);
            } else if (structs_.count(t.text) != 0 && tokens_[i + 1].text == "(") {
                const std::size_t close = closing(i + 1);
                put(t.space, t.text + "{");
                rewrite(i + 2, close);
                put(tokens_[close].space, "}");
                i = close;
            } else if (!t.text.empty() &&
                       std::isdigit(static_cast<unsigned char>(t.text[0])) != 0 &&
                       is_float(t.text)) {
                put(t.space, t.text + "f");
            } else if (t.text == "not") {
                put(t.space, "not_");
            } else {
                depth_ += t.text == "{" ? 1 : t.text == "}" ? -1 : 0;
                put(t.space, t.text);
            }
        }
    }

    // A declaration of an array, or an array made from values.
    std::size_t array(std::size_t i) {
        const bool named = is_name(tokens_[i + 1]);
        const std::size_t open = named ? i + 2 : i + 1;
        const std::size_t close = closing(open);
        std::string size;
        for (std::size_t k = open + 1; k < close; ++k) {
            size += tokens_[k].text;
        }
        put(tokens_[i].space, "replay_array<" + tokens_[i].text + ", " + size + ">");
        if (named) {
            put(tokens_[i + 1].space, tokens_[i + 1].text);
            return close;
        }
        if (tokens_[close + 1].text == "(") {
            const std::size_t last = closing(close + 1);
            put("", "{");
            rewrite(close + 2, last);
            put(tokens_[last].space, "}");
            return last;
        }
        return close;
    }

    // `type name(…) {` or `type[n] name(…) {`.
    bool is_function(std::size_t i) const {
        if (!is_name(tokens_[i])) {
            return false;
        }
        std::size_t name = i + 1;
        if (name < tokens_.size() && tokens_[name].text == "[") {
            name = closing(name) + 1;
        }
        return name + 1 < tokens_.size() && is_name(tokens_[name]) &&
               tokens_[name + 1].text == "(" && tokens_[closing(name + 1) + 1].text == "{";
    }

    std::size_t function(std::size_t i) {
        put(tokens_[i].space, "[[maybe_unused]] inline ");
        std::size_t name = i + 1;
        if (tokens_[name].text == "[") {
            const std::size_t close = closing(name);
            put("", "replay_array<" + tokens_[i].text + ", " + tokens_[name + 1].text + ">");
            name = close + 1;
        } else {
            put("", tokens_[i].text);
        }
        put(" ", tokens_[name].text + "(");
        const std::size_t close = closing(name + 1);
        std::vector<std::string> poisoned;
        for (std::size_t k = name + 2; k < close; ++k) {
            const std::string direction = tokens_[k].text;
            if (direction == "out" || direction == "inout") {
                const bool is_array_type = is_array(k + 1);
                const std::string type = is_array_type ? "replay_array<" + tokens_[k + 1].text +
                                                             ", " + tokens_[k + 4].text + ">"
                                                       : tokens_[k + 1].text;
                put(tokens_[k].space, type + "& " + tokens_[k + 2].text);
                if (direction == "out") {
                    poisoned.push_back(tokens_[k + 2].text);
                }
                k = is_array_type ? closing(k + 3) : k + 2;
            } else if (is_array(k)) {
                k = array(k);
            } else {
                put(tokens_[k].space, tokens_[k].text);
            }
        }
        put("", ")");
        put(tokens_[close + 1].space, "{");
        for (const std::string& each : poisoned) {
            put("\n", "    replay_poison(" + each + ");");
        }
        ++depth_;
        return close + 1;
    }

    std::vector<token> tokens_;
    std::set<std::string> structs_;
    std::string out_;
    int depth_ = 0;
};

} // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() < 3 || arguments.size() % 3 != 0) {
        std::cerr << "usage: glsl_to_cpp INPUT OUTPUT NAMESPACE [--replace FROM TO]...\n";
        return 2;
    }
    std::ifstream file(arguments[0], std::ios::binary);
    std::ostringstream buffer;
    buffer << file.rdbuf();
    std::string text = buffer.str();
    if (!file || text.empty()) {
        std::cerr << "glsl_to_cpp: cannot read " << arguments[0] << '\n';
        return 1;
    }
    for (std::size_t i = 3; i < arguments.size(); i += 3) {
        const auto at = text.find(arguments[i + 1]);
        if (arguments[i] != "--replace" || at == std::string::npos) {
            std::cerr << "glsl_to_cpp: \"" << arguments[i + 1] << "\" is not in " << arguments[0]
                      << '\n';
            return 1;
        }
        text.replace(at, arguments[i + 1].size(), arguments[i + 2]);
    }
    // guards must not hide a second copy in another namespace
    std::istringstream lines(text);
    std::string body;
    std::string line;
    std::vector<bool> guards;
    bool expects_define = false;
    while (std::getline(lines, line)) {
        if (line.rfind("#if", 0) == 0) {
            const bool is_guard = line.rfind("#ifndef ", 0) == 0 && line.size() > 5 &&
                                  line.compare(line.size() - 5, 5, "_GLSL") == 0;
            guards.push_back(is_guard);
            expects_define = is_guard;
            if (is_guard) {
                continue;
            }
        } else if (expects_define && line.rfind("#define ", 0) == 0) {
            expects_define = false;
            continue;
        } else if (line.rfind("#endif", 0) == 0 && !guards.empty()) {
            const bool was_guard = guards.back();
            guards.pop_back();
            if (was_guard) {
                continue;
            }
        }
        body += line + "\n";
    }
    std::ofstream out(arguments[1], std::ios::binary);
    out << "// Rewritten from GLSL; see glsl_to_cpp.cpp.\nnamespace " << arguments[2]
        << " {\nusing namespace glm;\nusing namespace replay_support;\n"
        << rewriter(tokens_of(body)).run() << "\n} // namespace " << arguments[2] << "\n";
    out.close();
    return out ? 0 : 1;
}
