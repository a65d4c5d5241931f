// The emitted GLSL on a device against the library, both judged by template<double>.
//
// Every function of the list runs in a compute shader on the same inputs as on the host. A result
// of the device is right if
//   - it is of the class (±infinity, finite) of the host's, and
//   - it is as far from the double result as a change of the inputs by a few ulp could have moved
//     that (the condition of the formula, found by evaluating such changes), or no further than
//     four times the host's own error, or
//   - it is discrete, and equal to the host's or to one that such a change would have given.
// Numbers below the smallest normal float may be flushed to zero, as GLSL allows.
//
// GLSL need not honour NaN, and llvmpipe does not: it turns !(x <= y) into x > y. Where a NaN comes
// in or arises on the way (the host's invalid flag tells), floats are counted and bools ignored;
// whole numbers must still lie in the range that the function gives for any value in place of the
// NaN, since they are what loops and indices are made of.
//
//   parity_device_test [--table]   prints the largest errors of each function
#include "harness.hpp"
#include "shared_headers.hpp"

#include <warpshadow/glsl.hpp>

#include "gl/context.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cfenv>
#include <cstring>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

namespace parity {

template <typename E>
requires std::is_enum_v<E>
struct twin<E> {
    using type = E;
};

#define WS_VARIABLE(name, type, array, direction) visit(a.name, b.name, #name);
#define WS_PLAIN_STRUCT(glsl_name, cpp_type, variables)                                            \
    template <> struct members<WS_STRIP cpp_type> {                                                \
        template <typename A, typename B, typename Visit>                                          \
        static void each(A& a, B& b, Visit visit) {                                                \
            variables                                                                              \
        }                                                                                          \
    };
#define WS_STRUCT(glsl_name, cpp_type, variables)                                                  \
    template <typename T> struct members<WS_STRIP cpp_type> {                                      \
        template <typename A, typename B, typename Visit>                                          \
        static void each(A& a, B& b, Visit visit) {                                                \
            variables                                                                              \
        }                                                                                          \
    };
#define WS_FUNCTION(...)
#include "shared_list.inc"
#undef WS_FUNCTION
#undef WS_PLAIN_STRUCT
#undef WS_STRUCT
#undef WS_VARIABLE

namespace {

// Members of the structs, for writing shaders.
const std::map<std::string_view, std::vector<variable>>& structs() {
#define WS_VARIABLE(name, type, array, direction) {#name, #type, array, direction},
#define WS_STRUCT(glsl_name, cpp_type, variables) {#glsl_name, {variables}},
#define WS_PLAIN_STRUCT WS_STRUCT
#define WS_FUNCTION(...)
    static const std::map<std::string_view, std::vector<variable>> all{
#include "shared_list.inc"
    };
#undef WS_FUNCTION
#undef WS_PLAIN_STRUCT
#undef WS_STRUCT
#undef WS_VARIABLE
    return all;
}

// Moves a value of any type between shader variables and words, one statement per scalar.
class shader_writer {
  public:
    std::string text;
    int words = 0;

    void move(std::string_view type, int array, const std::string& place, bool reads) {
        if (array > 0) {
            for (int i = 0; i < array; ++i) {
                move(type, 0, place + "[" + std::to_string(i) + "]", reads);
            }
        } else if (const auto found = structs().find(type); found != structs().end()) {
            for (const variable& each : found->second) {
                move(each.type, each.array, place + "." + std::string(each.name), reads);
            }
        } else if (type.starts_with("mat")) {
            const int columns = type[3] - '0';
            const int rows = type.size() > 4 ? type[5] - '0' : columns;
            for (int i = 0; i < columns; ++i) {
                move("vec" + std::to_string(rows), 0, place + "[" + std::to_string(i) + "]", reads);
            }
        } else if (const auto vec = type.find("vec"); vec != std::string_view::npos) {
            static const std::map<std::string_view, std::string_view> elements{
                {"", "float"}, {"i", "int"}, {"u", "uint"}, {"b", "bool"}};
            for (int i = 0; i < type.back() - '0'; ++i) {
                move(elements.at(type.substr(0, vec)), 0, place + "[" + std::to_string(i) + "]",
                     reads);
            }
        } else {
            scalar(type, place, reads);
        }
    }

  private:
    void scalar(std::string_view type, const std::string& place, bool reads) {
        const std::string word =
            (reads ? "inputs[in_base + " : "outputs[out_base + ") + std::to_string(words++) + "u]";
        if (type == "WS_TABLE") {
            text += "    " + place + " = tables[" + word + "].xyz;\n";
        } else if (reads) {
            const std::string value = type == "float"  ? "uintBitsToFloat(" + word + ")"
                                      : type == "int"  ? "int(" + word + ")"
                                      : type == "bool" ? word + " != 0u"
                                                       : word;
            text += "    " + place + " = " + value + ";\n";
        } else {
            const std::string value = type == "float"  ? "floatBitsToUint(" + place + ")"
                                      : type == "bool" ? place + " ? 1u : 0u"
                                                       : "uint(" + place + ")";
            text += "    " + word + " = " + value + ";\n";
        }
    }
};

std::string declare(std::string_view type, int array, const std::string& name) {
    return "    " + std::string(type) + " " + name +
           (array > 0 ? "[" + std::to_string(array) + "]" : "") + ";\n";
}

GLuint compile(const std::string& text) {
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    const char* data = text.c_str();
    glShaderSource(shader, 1, &data, nullptr);
    glCompileShader(shader);
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good == 0) {
        std::array<char, 4096> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        std::cerr << log.data() << '\n';
        glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
        std::cerr << log.data() << '\n';
    }
    glDeleteShader(shader);
    if (good == 0) {
        glDeleteProgram(program);
        return 0;
    }
    return program;
}

void fill_buffer(GLuint binding, const void* data, std::size_t size, GLuint buffer) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(size), data, GL_DYNAMIC_COPY);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

enum class kind { number, whole, truth };

enum class number_class { finite, nan, positive, negative };

number_class class_of(double x) {
    return std::isnan(x)    ? number_class::nan
           : !std::isinf(x) ? number_class::finite
           : x > 0.0        ? number_class::positive
                            : number_class::negative;
}

double flushed(double x) {
    return std::abs(x) < static_cast<double>(std::numeric_limits<float>::min()) ? 0.0 : x;
}

// A formula of n roundings may be off by n times what one rounding of its inputs does to the
// result: the longest chain of dependent operations in the shared functions is about this long.
constexpr double roundings = 64.0;

struct summary {
    std::string name;
    double device = 0.0;   // largest error in units of the condition
    double host = 0.0;     // the same for the host
    std::size_t equal = 0; // outputs equal to the host's to the bit
    std::size_t outputs = 0;
    std::size_t special = 0; // floats after a NaN that are of another class than the host's
    std::size_t wrong = 0;
};

class device_check {
  public:
    explicit device_check(std::size_t count) : count_(count), tables_(seed()) {
        glGenBuffers(4, buffers_.data());
        std::vector<float> nodes;
        std::vector<std::int32_t> places;
        for (const table_set::table& each : tables_.tables) {
            places.insert(places.end(),
                          {static_cast<std::int32_t>(nodes.size()), each.cells, each.rows, 0});
            nodes.insert(nodes.end(), each.nodes.begin(), each.nodes.end());
        }
        fill_buffer(0, nodes.data(), nodes.size() * sizeof(float), buffers_[0]);
        fill_buffer(3, places.data(), places.size() * sizeof(std::int32_t), buffers_[3]);
    }

    template <typename FloatResult, typename DoubleResult, typename FloatTuple,
              typename DoubleTuple, typename Host, typename Reference>
    summary compare(std::string_view name, std::string_view result_type,
                    const std::vector<variable>& variables, Host host, Reference reference) {
        summary sum;
        sum.name = name;
        shader_writer reader;
        shader_writer writer;
        std::string arguments;
        std::string declarations;
        for (std::size_t i = 0; i < variables.size(); ++i) {
            const std::string local = "argument" + std::to_string(i);
            declarations += declare(variables[i].type, variables[i].array, local);
            reader.move(variables[i].type, variables[i].array, local, true);
            arguments += (i > 0 ? ", " : "") + local;
        }
        constexpr bool is_void = std::is_void_v<FloatResult>;
        const auto bracket = result_type.find('[');
        const int result_array =
            bracket == std::string_view::npos
                ? 0
                : std::atoi(std::string(result_type.substr(bracket + 1)).c_str());
        if (!is_void) {
            writer.move(result_type.substr(0, bracket), result_array, "result", false);
        }
        for (std::size_t i = 0; i < variables.size(); ++i) {
            if (!variables[i].direction.empty()) {
                writer.move(variables[i].type, variables[i].array, "argument" + std::to_string(i),
                            false);
            }
        }
        warpshadow::glsl::options how;
        how.target = warpshadow::glsl::profile::gl430;
        how.tables = warpshadow::glsl::table_access::buffer;
        std::string body = warpshadow::glsl::emit({name}, how).text;
        if (body.find("#define WS_TABLE ") == std::string::npos) {
            body += "#define WS_TABLE ivec3\n";
        }
        const std::string text =
            "#version 430 core\nlayout(local_size_x = 64) in;\n" + body +
            "layout(std430, binding = 1) readonly buffer in_buffer { uint inputs[]; };\n"
            "layout(std430, binding = 2) writeonly buffer out_buffer { uint outputs[]; };\n"
            "layout(std430, binding = 3) readonly buffer table_buffer { ivec4 tables[]; };\n"
            "uniform uint count;\n"
            "void main()\n{\n"
            "    uint id = gl_GlobalInvocationID.x;\n"
            "    if (id >= count) {\n        return;\n    }\n"
            "    uint in_base = id * " +
            std::to_string(reader.words) + "u;\n    uint out_base = id * " +
            std::to_string(writer.words) + "u;\n" + declarations + reader.text +
            (is_void ? "    " + std::string(name) + "(" + arguments + ");\n"
                     : "    " +
                           (result_array > 0 ? std::string(result_type.substr(0, bracket)) +
                                                   " result[" + std::to_string(result_array) + "]"
                                             : std::string(result_type) + " result") +
                           " = " + std::string(name) + "(" + arguments + ");\n") +
            writer.text + "}\n";
        const GLuint program = compile(text);
        if (program == 0) {
            std::cerr << text;
            sum.wrong = count_;
            return sum;
        }

        // inputs: one half hard, one half ordinary
        generator from(seed() ^ std::hash<std::string_view>{}(name));
        std::vector<FloatTuple> inputs(count_);
        std::vector<std::uint32_t> words;
        words.reserve(count_ * static_cast<std::size_t>(reader.words) + 1);
        for (std::size_t n = 0; n < count_; ++n) {
            std::size_t index = 0;
            const bool ordinary = n % 2 == 1;
            std::apply(
                [&](auto&... value) {
                    (input(value, from, name, variables[index++], ordinary, words), ...);
                },
                inputs[n]);
        }
        words.push_back(0); // never empty
        std::vector<std::uint32_t> results(count_ * static_cast<std::size_t>(writer.words) + 1);
        fill_buffer(1, words.data(), words.size() * sizeof(words[0]), buffers_[1]);
        fill_buffer(2, results.data(), results.size() * sizeof(results[0]), buffers_[2]);
        glUseProgram(program);
        glUniform1ui(glGetUniformLocation(program, "count"), static_cast<GLuint>(count_));
        glDispatchCompute(static_cast<GLuint>((count_ + 63) / 64), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0,
                           static_cast<GLsizeiptr>(results.size() * sizeof(results[0])),
                           results.data());
        glDeleteProgram(program);

        for (std::size_t n = 0; n < count_; ++n) {
            judge<FloatResult, DoubleResult, DoubleTuple>(
                sum, variables, inputs[n],
                std::span(results).subspan(n * static_cast<std::size_t>(writer.words),
                                           static_cast<std::size_t>(writer.words)),
                host, reference);
        }
        return sum;
    }

  private:
    // All scalars of result and written parameters, as double.
    template <typename Result, typename Tuple, typename Function>
    [[gnu::noinline]] static std::vector<double>
    evaluate(Tuple arguments, const std::vector<variable>& variables, Function function,
             std::vector<kind>* kinds = nullptr) {
        std::vector<double> all;
        const auto take = [&](const auto& scalar, const auto&, std::string_view) {
            all.push_back(static_cast<double>(scalar));
            using type = std::remove_cvref_t<decltype(scalar)>;
            if (kinds != nullptr) {
                kinds->push_back(std::is_floating_point_v<type> ? kind::number
                                 : std::is_same_v<type, bool>   ? kind::truth
                                                                : kind::whole);
            }
        };
        if constexpr (std::is_void_v<Result>) {
            std::apply(function, arguments);
        } else {
            const Result result = std::apply(function, arguments);
            each_scalar(result, result, "", take);
        }
        std::size_t index = 0;
        std::apply(
            [&](const auto&... value) {
                ((variables[index].direction.empty() ? void() : each_scalar(value, value, "", take),
                  ++index),
                 ...);
            },
            arguments);
        return all;
    }

    template <typename FloatResult, typename DoubleResult, typename DoubleTuple,
              typename FloatTuple, typename Host, typename Reference>
    void judge(summary& sum, const std::vector<variable>& variables, const FloatTuple& input,
               std::span<const std::uint32_t> got, Host host, Reference reference) {
        std::vector<kind> kinds;
        std::feclearexcept(FE_INVALID);
        const std::vector<double> on_host = evaluate<FloatResult>(input, variables, host, &kinds);
        const bool nan_on_the_way =
            std::fetestexcept(FE_INVALID) != 0 || has(input, [](float x) { return std::isnan(x); });
        std::vector<double> on_device(on_host.size());
        bool same = true;
        for (std::size_t i = 0; i < got.size(); ++i) {
            on_device[i] = kinds[i] == kind::number
                               ? static_cast<double>(std::bit_cast<float>(got[i]))
                               : static_cast<double>(got[i]);
            if (kinds[i] == kind::whole && on_host[i] < 0.0) {
                on_device[i] = static_cast<double>(static_cast<std::int32_t>(got[i]));
            }
            const bool equal =
                on_device[i] == on_host[i] || (std::isnan(on_device[i]) && std::isnan(on_host[i]));
            sum.equal += equal ? 1u : 0u;
            same = same && equal;
        }
        sum.outputs += got.size();
        if (same) {
            return; // nothing to judge
        }
        if (nan_on_the_way) {
            judge_after_nan<FloatResult>(sum, variables, input, kinds, on_host, on_device, host);
            return;
        }
        // the exact answer, and what it becomes when the inputs move a little
        const DoubleTuple exact = widened<DoubleTuple>(input);
        const std::vector<double> truth = evaluate<DoubleResult>(exact, variables, reference);
        std::vector<std::vector<double>> nearby;
        generator noise(sum.outputs);
        for (int k = 0; k < 12; ++k) {
            FloatTuple moved = input;
            move(moved, noise, k);
            nearby.push_back(
                evaluate<DoubleResult>(widened<DoubleTuple>(moved), variables, reference));
            nearby.push_back(evaluate<FloatResult>(moved, variables, host));
        }
        // and what the roundings inside the formula do: the same in float, rounded other ways
        for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
            FloatTuple moved = input;
            for (int k = 0; k < 3; ++k) {
                std::fesetround(mode);
                nearby.push_back(evaluate<FloatResult>(moved, variables, host));
                std::fesetround(FE_TONEAREST);
                move(moved, noise, 1);
            }
        }
        for (std::size_t i = 0; i < got.size(); ++i) {
            const double device = on_device[i];
            if (device == on_host[i] || (std::isnan(device) && std::isnan(on_host[i]))) {
                continue;
            }
            bool good = false;
            if (kinds[i] != kind::number) {
                good = device == truth[i];
                for (const std::vector<double>& each : nearby) {
                    good = good || device == each[i];
                }
            } else {
                double spread = 0.0;
                for (const std::vector<double>& each : nearby) {
                    // overflow may come a little earlier or later
                    good = good || class_of(static_cast<double>(static_cast<float>(each[i]))) ==
                                       class_of(device);
                    if (std::isfinite(each[i])) {
                        spread = std::max(spread, std::abs(each[i] - truth[i]));
                    }
                }
                constexpr double unit = 0x1p-24;
                const double smallest = static_cast<double>(std::numeric_limits<float>::min());
                const double condition = spread + unit * std::abs(truth[i]) + smallest;
                const double error = std::abs(device - truth[i]);
                const double host_error = std::abs(on_host[i] - truth[i]);
                if (class_of(device) == number_class::finite &&
                    class_of(on_host[i]) == number_class::finite) {
                    good = error <= roundings * condition || error <= 4.0 * host_error;
                    sum.device = std::max(sum.device, error / condition);
                    sum.host = std::max(sum.host, host_error / condition);
                } else {
                    // where the host itself left the range of float on the way, nothing is promised
                    good = good || !(host_error <= roundings * condition);
                }
            }
            if (good) {
                continue;
            }
            if (++sum.wrong == 1) {
                report(sum.name, variables, input, i, on_host[i], device, truth[i]);
            }
        }
    }

    template <typename FloatResult, typename FloatTuple, typename Host>
    void judge_after_nan(summary& sum, const std::vector<variable>& variables,
                         const FloatTuple& input, const std::vector<kind>& kinds,
                         const std::vector<double>& on_host, const std::vector<double>& on_device,
                         Host host) {
        std::vector<double> lowest = on_host;
        std::vector<double> highest = on_host;
        generator other(sum.outputs);
        for (int k = 0; k < 32; ++k) {
            FloatTuple replaced = input;
            std::apply(
                [&](auto&... value) {
                    (each_scalar(
                         value, value, "",
                         [&](auto& scalar, auto&, std::string_view) {
                             if constexpr (std::is_same_v<std::remove_cvref_t<decltype(scalar)>,
                                                          float>) {
                                 // an infinity may have met zero or another infinity
                                 if (!(std::abs(scalar) <= 1.0e30f)) {
                                     scalar = other.number();
                                 }
                             }
                         }),
                     ...);
                },
                replaced);
            const std::vector<double> result = evaluate<FloatResult>(replaced, variables, host);
            for (std::size_t i = 0; i < result.size(); ++i) {
                lowest[i] = std::min(lowest[i], result[i]);
                highest[i] = std::max(highest[i], result[i]);
            }
        }
        for (std::size_t i = 0; i < on_host.size(); ++i) {
            if (kinds[i] == kind::number) {
                sum.special += class_of(on_device[i]) != class_of(on_host[i]) ? 1u : 0u;
            } else if (kinds[i] == kind::whole &&
                       (on_device[i] < lowest[i] || on_device[i] > highest[i])) {
                if (++sum.wrong == 1) {
                    report(sum.name, variables, input, i, on_host[i], on_device[i], highest[i]);
                }
            }
        }
    }

    template <typename Value>
    void input(Value& value, generator& from, std::string_view function, const variable& which,
               bool ordinary, std::vector<std::uint32_t>& words) {
        if constexpr (is_table<Value>::value) {
            const std::uint32_t index = from.below(tables_.tables.size());
            value = tables_.view<float>(index);
            words.push_back(index);
        } else {
            fill(value, from, function, which.name,
                 ordinary ? inputs_are::ordinary : inputs_are::valid);
            each_scalar(value, value, "", [&](const auto& scalar, const auto&, std::string_view) {
                words.push_back(bits(scalar));
            });
        }
    }

    template <typename Tuple, typename Test> static bool has(const Tuple& values, Test test) {
        bool found = false;
        std::apply(
            [&](const auto&... value) {
                (each_scalar(value, value, "",
                             [&](const auto& scalar, const auto&, std::string_view) {
                                 if constexpr (std::is_same_v<std::remove_cvref_t<decltype(scalar)>,
                                                              float>) {
                                     found = found || test(scalar);
                                 }
                             }),
                 ...);
            },
            values);
        return found;
    }

    // Number k of the changes: flush subnormal inputs, else each input by up to k ulp.
    template <typename Tuple> static void move(Tuple& values, generator& noise, int k) {
        std::apply(
            [&](auto&... value) {
                (each_scalar(
                     value, value, "",
                     [&](auto& scalar, auto&, std::string_view) {
                         if constexpr (std::is_same_v<std::remove_cvref_t<decltype(scalar)>,
                                                      float>) {
                             if (k == 0) {
                                 scalar = static_cast<float>(flushed(static_cast<double>(scalar)));
                                 return;
                             }
                             const std::uint32_t steps =
                                 noise.below(static_cast<std::size_t>(k < 8 ? 2 : 5));
                             const float towards = noise.below(2) == 0
                                                       ? std::numeric_limits<float>::max()
                                                       : -std::numeric_limits<float>::max();
                             for (std::uint32_t s = 0; s < steps && std::isfinite(scalar); ++s) {
                                 scalar = std::nextafter(scalar, towards);
                             }
                         }
                     }),
                 ...);
            },
            values);
    }

    template <typename DoubleTuple, typename FloatTuple>
    DoubleTuple widened(const FloatTuple& from) {
        DoubleTuple result;
        widen(from, result, std::make_index_sequence<std::tuple_size_v<FloatTuple>>());
        return result;
    }
    template <typename A, typename B, std::size_t... I>
    void widen(const A& a, B& b, std::index_sequence<I...>) {
        (widen_one(std::get<I>(a), std::get<I>(b)), ...);
    }
    template <typename A, typename B> void widen_one(const A& a, B& b) {
        if constexpr (is_table<A>::value) {
            for (std::size_t i = 0; i < tables_.tables.size(); ++i) {
                if (tables_.tables[i].nodes.data() == a.nodes.data()) {
                    if constexpr (std::is_same_v<A, B>) {
                        b = a;
                    } else {
                        b = tables_.view<double>(i);
                    }
                }
            }
        } else {
            each_scalar(a, b, "", [](const auto& x, auto& y, std::string_view) {
                y = static_cast<std::remove_cvref_t<decltype(y)>>(x);
            });
        }
    }

    template <typename Inputs>
    static void report(std::string_view name, const std::vector<variable>& variables,
                       const Inputs& inputs, std::size_t output, double host, double device,
                       double truth) {
        std::string text(name);
        std::size_t index = 0;
        std::apply(
            [&](const auto&... value) {
                ((text += "\n  " + std::string(variables[index].name) + ": " + describe(value),
                  ++index),
                 ...);
            },
            inputs);
        std::fprintf(stderr, "wrong: %s\n  output %zu: host %.9g, device %.9g, double %.17g\n",
                     text.c_str(), output, host, device, truth);
    }

    std::size_t count_;
    table_set tables_;
    std::array<GLuint, 4> buffers_{};
};

} // namespace
} // namespace parity

int main(int argc, char** argv) {
    const bool table = argc > 1 && std::strcmp(argv[1], "--table") == 0;
    std::unique_ptr<gl::headless_context> context;
    try {
        context = std::make_unique<gl::headless_context>();
    } catch (const gl::error& error) {
        std::cout << "skipped: " << error.what() << '\n';
        return 77;
    }
    std::cout << context->info().renderer << ", " << context->info().version << '\n';

    // the whole text with `precise`, which the functions above are not compiled with
    warpshadow::glsl::options precise;
    precise.target = warpshadow::glsl::profile::gl450;
    precise.precise = true;
    int failures = 0;
    if (context->info().major * 10 + context->info().minor >= 45 &&
        parity::compile("#version 450 core\nlayout(local_size_x = 1) in;\n" +
                        warpshadow::glsl::emit({"all"}, precise).text + "void main() {}\n") == 0) {
        std::cerr << "FAILED: the text with precise does not compile\n";
        ++failures;
    }

    const std::size_t count = parity::input_count(8'192);
    parity::device_check check(count);
    int functions = 0;
    const auto judge = [&](const parity::summary& sum) {
        ++functions;
        if (table) {
            std::cout << std::left << std::setw(28) << sum.name << std::right << std::setw(8)
                      << std::fixed << std::setprecision(2)
                      << 100.0 * static_cast<double>(sum.equal) /
                             static_cast<double>(std::max<std::size_t>(sum.outputs, 1))
                      << " % equal, error/condition: device " << sum.device << ", host " << sum.host
                      << ", of another class after NaN " << sum.special << '\n';
        }
        if (sum.wrong != 0) {
            ++failures;
            std::cerr << "FAILED " << sum.name << ": " << sum.wrong << " of " << sum.outputs
                      << " outputs\n";
        }
    };

#define WS_STRUCT(...)
#define WS_PLAIN_STRUCT(...)
#define WS_VARIABLE(name, type, array, direction) {#name, #type, array, direction},
#define WS_FUNCTION(glsl_name, cpp_name, cpp_result, cpp_parameters, glsl_result, variables)       \
    {                                                                                              \
        const auto with = [&]<typename T>(T, auto then) {                                          \
            then.template operator()<WS_STRIP cpp_result, std::tuple<WS_STRIP cpp_parameters>>(    \
                [](auto&... arguments) { return WS_STRIP cpp_name(arguments...); });               \
        };                                                                                         \
        with(0.0f, [&]<typename FloatResult, typename FloatTuple>(auto host) {                     \
            with(0.0, [&]<typename DoubleResult, typename DoubleTuple>(auto reference) {           \
                judge(check.compare<FloatResult, DoubleResult, FloatTuple, DoubleTuple>(           \
                    #glsl_name, #glsl_result, {variables}, host, reference));                      \
            });                                                                                    \
        });                                                                                        \
    }
#include "shared_list.inc"

    std::cout << functions << " functions, " << count << " inputs each, " << failures
              << " failures\n";
    return failures == 0 && functions > 0 ? 0 : 1;
}
