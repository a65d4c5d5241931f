// Names that GLSL keeps for itself.
#pragma once

namespace refused {

inline float sample(float input) {
    float output = input;
    float filter = output;
    return filter;
}
inline float underscores(float double__underscore) {
    return double__underscore;
}
inline float also__here(float x) {
    return x;
}
inline float builtin_prefix(float gl_value, float ws_value) {
    return gl_value + ws_value;
}
struct members {
    float half;
    float active;
};
inline float sum(members m) {
    return m.half + m.active;
}

} // namespace refused
