// From a C++ file of explicit instantiations to the GLSL of everything they need.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace glslgen {

enum class entity_kind { constant, enumeration, structure, function };

/// A struct member or a parameter, as GLSL and as C++ with the scalar type written T.
struct variable {
    std::string name;
    std::string type;      ///< GLSL type without the array part
    int array = 0;         ///< number of elements, 0 for no array
    std::string direction; ///< parameters: "", "out" or "inout"
    std::string cpp_type;  ///< C++ type as a template of T
};

/// One struct, constant, enumeration or function of the output.
struct entity {
    entity_kind kind = entity_kind::function;
    std::string name;                      ///< GLSL name, with prefix ws_
    std::string cpp_name;                  ///< qualified C++ name
    std::string topic;                     ///< stem of the header it was written in
    std::string doc;                       ///< doc comment, `///` lines
    std::string text;                      ///< GLSL, without the doc comment
    std::vector<std::size_t> dependencies; ///< indices of what it uses
    std::string source;                    ///< C++ text it was made from
    unsigned offset = 0;                   ///< place in its header
    std::string result;                    ///< functions: GLSL type of the result
    std::string cpp_result;                ///< functions: C++ type of the result
    std::string cpp_call;                  ///< functions: C++ name with template arguments
    std::vector<variable> variables;       ///< parameters or members
    bool is_template = false;              ///< whether the C++ is a template of T
    bool is_method = false;                ///< whether the first parameter was `this`
};

/// Everything that was translated, callees before callers and each topic in one piece.
struct translation {
    std::vector<entity> entities;
    std::vector<std::string> topics; ///< a topic stands after those it needs
    std::vector<std::string> inputs; ///< every file that was read, but for system headers
};

struct translation_options {
    std::string source;             ///< file with the instantiations
    std::vector<std::string> flags; ///< for the compiler
    std::string resource_folder;    ///< of the compiler's own headers
};

/// Translates; diagnostics go to stderr as the compiler writes them.
/// @param[out] result untouched if something was refused
/// @return whether all was well
bool translate(const translation_options& options, translation& result);

} // namespace glslgen
