#include "gl/objects.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace gl {
namespace detail {
void delete_buffer(GLuint id) {
    glDeleteBuffers(1, &id);
}
void delete_texture(GLuint id) {
    glDeleteTextures(1, &id);
}
void delete_framebuffer(GLuint id) {
    glDeleteFramebuffers(1, &id);
}
void delete_vertex_array(GLuint id) {
    glDeleteVertexArrays(1, &id);
}
void delete_program(GLuint id) {
    glDeleteProgram(id);
}
void delete_query(GLuint id) {
    glDeleteQueries(1, &id);
}
} // namespace detail

namespace {

/// Client format and type of an internal format, and its size.
struct texel {
    GLenum internal;
    GLenum format;
    GLenum type;
    std::size_t bytes;
};

constexpr texel texels[] = {
    {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1},
    {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    {GL_R16, GL_RED, GL_UNSIGNED_SHORT, 2},
    {GL_R16F, GL_RED, GL_HALF_FLOAT, 2},
    {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8},
    {GL_R32F, GL_RED, GL_FLOAT, 4},
    {GL_RG32F, GL_RG, GL_FLOAT, 8},
    {GL_RGB32F, GL_RGB, GL_FLOAT, 12},
    {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1},
    {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4},
    {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8},
    {GL_RGB32UI, GL_RGB_INTEGER, GL_UNSIGNED_INT, 12},
    {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16},
    {GL_R32I, GL_RED_INTEGER, GL_INT, 4},
    {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, 2},
    {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 4},
    {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4},
};

const texel& texel_of(GLenum internal) {
    for (const texel& each : texels) {
        if (each.internal == internal) {
            return each;
        }
    }
    throw error("texture format " + std::to_string(internal) + " is not in the table");
}

bool is_depth(GLenum internal) {
    return texel_of(internal).format == GL_DEPTH_COMPONENT;
}

GLuint generate(void (*function)(GLsizei, GLuint*)) {
    GLuint id = 0;
    function(1, &id);
    return id;
}

/// Attaches one texture to a framebuffer of its own while the caller clears it.
class scratch_target {
  public:
    explicit scratch_target(const texture& target) {
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before_);
        glGenFramebuffers(1, &id_);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id_);
        glFramebufferTexture(GL_DRAW_FRAMEBUFFER,
                             is_depth(target.format()) ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0,
                             target.id(), 0);
    }
    scratch_target(const scratch_target&) = delete;
    scratch_target& operator=(const scratch_target&) = delete;
    ~scratch_target() {
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(before_));
        glDeleteFramebuffers(1, &id_);
    }

  private:
    GLint before_ = 0;
    GLuint id_ = 0;
};

const char* stage_name(GLenum type) {
    switch (type) {
    case GL_VERTEX_SHADER:
        return "vertex shader";
    case GL_TESS_CONTROL_SHADER:
        return "tessellation control shader";
    case GL_TESS_EVALUATION_SHADER:
        return "tessellation evaluation shader";
    case GL_GEOMETRY_SHADER:
        return "geometry shader";
    case GL_FRAGMENT_SHADER:
        return "fragment shader";
    default:
        return "compute shader";
    }
}

/// Line `line` of source string `file`, found by the #line directives of `text`.
std::string quoted_line(const std::string& text, std::size_t file, std::size_t line) {
    std::istringstream in(text);
    std::string each;
    std::size_t at_file = 0;
    std::size_t at_line = 1;
    while (std::getline(in, each)) {
        if (each.starts_with("#line ")) {
            std::istringstream numbers(each.substr(6));
            numbers >> at_line >> at_file;
            continue;
        }
        if (at_file == file && at_line == line) {
            return each;
        }
        ++at_line;
    }
    return {};
}

/// Puts file names into a compiler's log: "0:12(5): …" (Mesa), "0(12) : …" (NVIDIA) and
/// "ERROR: 0:12: …" (others) become "name:12: …", followed by the line itself.
std::string readable_log(const shader_source& source, const std::string& log) {
    std::istringstream in(log);
    std::string out;
    std::string each;
    while (std::getline(in, each)) {
        const char* const end = each.data() + each.size();
        const std::size_t start = each.find_first_of("0123456789");
        std::size_t file = 0;
        std::size_t line = 0;
        const char* rest = end;
        if (start == 0 || (start != std::string::npos && each[start - 1] == ' ')) {
            const auto number = std::from_chars(each.data() + start, end, file);
            if (number.ptr != end && (*number.ptr == ':' || *number.ptr == '(')) {
                const auto second = std::from_chars(number.ptr + 1, end, line);
                rest = second.ptr;
                if (second.ec != std::errc()) {
                    line = 0;
                }
            }
        }
        if (line == 0 || file >= source.files.size()) {
            out += "  " + each + "\n";
            continue;
        }
        const std::string where(rest, end);
        const std::size_t colon = where.find(':');
        out += "  " + source.files[file] + ":" + std::to_string(line) +
               (colon == std::string::npos ? ": " + where : where.substr(colon)) + "\n";
        out += "      " + quoted_line(source.text, file, line) + "\n";
    }
    return out;
}

std::string info_log(GLuint id, void (*parameter)(GLuint, GLenum, GLint*),
                     void (*get)(GLuint, GLsizei, GLsizei*, GLchar*)) {
    GLint length = 0;
    parameter(id, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 0)), '\0');
    if (length > 0) {
        get(id, length, nullptr, log.data());
        log.resize(log.find('\0') == std::string::npos ? log.size() : log.find('\0'));
    }
    return log;
}

} // namespace

void check(const char* where) {
    const GLenum code = glGetError();
    if (code == GL_NO_ERROR) {
        return;
    }
    const char* name = code == GL_INVALID_ENUM                    ? "invalid enum"
                       : code == GL_INVALID_VALUE                 ? "invalid value"
                       : code == GL_INVALID_OPERATION             ? "invalid operation"
                       : code == GL_OUT_OF_MEMORY                 ? "out of memory"
                       : code == GL_INVALID_FRAMEBUFFER_OPERATION ? "invalid framebuffer operation"
                                                                  : "error";
    throw error("OpenGL: " + std::string(name) + " in " + where);
}

void wait_for_writes() {
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

buffer::buffer(std::size_t bytes, const void* data, GLenum usage)
    : handle_(generate(glGenBuffers)), bytes_(bytes) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, id());
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes), data, usage);
    check("glBufferData");
}

void buffer::bind(GLenum target) const {
    glBindBuffer(target, id());
}

void buffer::bind_base(GLenum target, GLuint index) const {
    glBindBufferBase(target, index, id());
}

void buffer::write(std::size_t offset, std::size_t bytes, const void* data) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, id());
    glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(bytes), data);
}

void buffer::read(std::size_t offset, std::size_t bytes, void* data) const {
    glBindBuffer(GL_COPY_READ_BUFFER, id());
    glGetBufferSubData(GL_COPY_READ_BUFFER, static_cast<GLintptr>(offset),
                       static_cast<GLsizeiptr>(bytes), data);
}

void buffer::fill(std::uint32_t value) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, id());
    glClearBufferData(GL_COPY_WRITE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

// Unit for what is not drawing: units below it keep what the caller bound there. GL 4.3 promises
// 80 of them in all, 16 a stage.
static constexpr GLuint spare_unit = 79;

texture::texture(GLenum internal_format, int width, int height)
    : texture(internal_format, width, height, 0) {}

texture::texture(GLenum internal_format, int width, int height, int layers)
    : handle_(generate(glGenTextures)), format_(internal_format), width_(width), height_(height),
      layers_(layers) {
    bind(spare_unit);
    if (layers > 0) {
        glTexStorage3D(target(), 1, internal_format, width, height, layers);
    } else {
        glTexStorage2D(target(), 1, internal_format, width, height);
    }
    check("glTexStorage");
    glTexParameteri(target(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(target(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

std::size_t texture::bytes() const {
    return format_ == GL_NONE ? 0
                              : texel_of(format_).bytes * static_cast<std::size_t>(width_) *
                                    static_cast<std::size_t>(height_) *
                                    static_cast<std::size_t>(std::max(layers_, 1));
}

void texture::bind(GLuint unit) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target(), id());
}

buffer_texture::buffer_texture(const buffer& source, GLenum internal_format)
    : handle_(generate(glGenTextures)) {
    // OpenGL would cut what is beyond without a word
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    const std::size_t count = source.bytes() / texel_of(internal_format).bytes;
    if (count > static_cast<std::size_t>(most)) {
        throw error("a buffer of " + std::to_string(count) +
                    " texels is too large: this OpenGL takes up to " + std::to_string(most));
    }
    bind(spare_unit);
    glTexBuffer(GL_TEXTURE_BUFFER, internal_format, source.id());
    check("glTexBuffer");
}

void buffer_texture::bind(GLuint unit) const {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_BUFFER, id());
}

void texture::bind_image(GLuint unit, GLenum access) const {
    glBindImageTexture(unit, id(), 0, layers_ > 0 ? GL_TRUE : GL_FALSE, 0, access, format_);
}

void texture::set_filter(GLenum filter) {
    bind(spare_unit);
    glTexParameteri(target(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
    glTexParameteri(target(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
}

void texture::set_compare(GLenum function) {
    bind(spare_unit);
    glTexParameteri(target(), GL_TEXTURE_COMPARE_MODE,
                    function == GL_NONE ? GL_NONE : GL_COMPARE_REF_TO_TEXTURE);
    if (function != GL_NONE) {
        glTexParameteri(target(), GL_TEXTURE_COMPARE_FUNC, static_cast<GLint>(function));
    }
}

void texture::clear(glm::vec4 value) {
    const scratch_target target(*this);
    glClearBufferfv(GL_COLOR, 0, &value[0]);
}

void texture::clear(glm::uvec4 value) {
    const scratch_target target(*this);
    glClearBufferuiv(GL_COLOR, 0, &value[0]);
}

void texture::clear_depth(float value) {
    const scratch_target target(*this);
    glClearBufferfv(GL_DEPTH, 0, &value);
}

void texture::write(const void* data) {
    const texel& t = texel_of(format_);
    bind(spare_unit);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (layers_ > 0) {
        glTexSubImage3D(target(), 0, 0, 0, 0, width_, height_, layers_, t.format, t.type, data);
    } else {
        glTexSubImage2D(target(), 0, 0, 0, width_, height_, t.format, t.type, data);
    }
}

void texture::read(void* data, std::size_t size) const {
    if (size < bytes()) {
        throw error("texture::read: the destination is too small");
    }
    const texel& t = texel_of(format_);
    bind(spare_unit);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(target(), 0, t.format, t.type, data);
}

framebuffer::framebuffer(std::initializer_list<const texture*> colours, const texture* depth)
    : handle_(generate(glGenFramebuffers)) {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    std::vector<GLenum> targets;
    for (const texture* colour : colours) {
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size());
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, colour->id(), 0);
        targets.push_back(attachment);
        width_ = colour->width();
        height_ = colour->height();
    }
    if (depth != nullptr) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth->id(), 0);
        width_ = depth->width();
        height_ = depth->height();
    }
    finish(targets);
}

framebuffer framebuffer::of_layer(const texture& depth, int layer) {
    framebuffer result;
    result.handle_ = handle<detail::delete_framebuffer>(generate(glGenFramebuffers));
    glBindFramebuffer(GL_FRAMEBUFFER, result.id());
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth.id(), 0, layer);
    result.width_ = depth.width();
    result.height_ = depth.height();
    result.finish({});
    return result;
}

framebuffer framebuffer::of_layers(const texture& depth) {
    framebuffer result;
    result.handle_ = handle<detail::delete_framebuffer>(generate(glGenFramebuffers));
    glBindFramebuffer(GL_FRAMEBUFFER, result.id());
    glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth.id(), 0);
    result.width_ = depth.width();
    result.height_ = depth.height();
    result.finish({});
    return result;
}

void framebuffer::finish(std::span<const GLenum> colours) {
    if (colours.empty()) {
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    } else {
        glDrawBuffers(static_cast<GLsizei>(colours.size()), colours.data());
    }
    const GLenum state = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (state != GL_FRAMEBUFFER_COMPLETE) {
        throw error("framebuffer is not complete (" + std::to_string(state) + ")");
    }
}

void framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glViewport(0, 0, width_, height_);
}

vertex_array::vertex_array() : handle_(generate(glGenVertexArrays)) {}

void vertex_array::bind() const {
    glBindVertexArray(id());
}

program::program(std::initializer_list<stage> stages) : handle_(glCreateProgram()) {
    bool computes = false;
    std::string names;
    for (const stage& each : stages) {
        const std::string& name = each.source.files.front();
        names += (names.empty() ? "" : ", ") + name;
        computes = computes || each.type == GL_COMPUTE_SHADER;
        const GLuint shader = glCreateShader(each.type);
        const GLchar* text = each.source.text.c_str();
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        const std::string log = compiled == GL_TRUE
                                    ? std::string()
                                    : info_log(shader, glGetShaderiv, glGetShaderInfoLog);
        glAttachShader(id(), shader);
        glDeleteShader(shader);
        if (compiled != GL_TRUE) {
            throw error("cannot compile " + std::string(stage_name(each.type)) + " " + name +
                        ":\n" + readable_log(each.source, log));
        }
    }
    glLinkProgram(id());
    GLint linked = GL_FALSE;
    glGetProgramiv(id(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        throw error("cannot link " + names + ":\n" +
                    info_log(id(), glGetProgramiv, glGetProgramInfoLog));
    }
    if (computes) {
        glGetProgramiv(id(), GL_COMPUTE_WORK_GROUP_SIZE, &group_size_[0]);
    }
}

void program::use() const {
    glUseProgram(id());
}

void program::dispatch(glm::ivec3 size) const {
    const glm::ivec3 groups = (glm::max(size, glm::ivec3(1)) + group_size_ - 1) / group_size_;
    glUseProgram(id());
    glDispatchCompute(static_cast<GLuint>(groups.x), static_cast<GLuint>(groups.y),
                      static_cast<GLuint>(groups.z));
}

void program::dispatch_over(std::size_t count) const {
    const std::size_t most = std::size_t{65535} * static_cast<std::size_t>(group_size_.x);
    dispatch(static_cast<int>(std::min(count, most)));
}

GLint program::location(const char* name) const {
    const auto [entry, fresh] = locations_.try_emplace(name, -1);
    if (fresh) {
        entry->second = glGetUniformLocation(id(), name);
    }
    return entry->second;
}

void program::set(const char* name, int value) const {
    glProgramUniform1i(id(), location(name), value);
}
void program::set(const char* name, unsigned value) const {
    glProgramUniform1ui(id(), location(name), value);
}
void program::set(const char* name, float value) const {
    glProgramUniform1f(id(), location(name), value);
}
void program::set(const char* name, glm::ivec2 value) const {
    glProgramUniform2iv(id(), location(name), 1, &value[0]);
}
void program::set(const char* name, glm::ivec3 value) const {
    glProgramUniform3iv(id(), location(name), 1, &value[0]);
}
void program::set(const char* name, glm::uvec2 value) const {
    glProgramUniform2uiv(id(), location(name), 1, &value[0]);
}
void program::set(const char* name, glm::vec2 value) const {
    glProgramUniform2fv(id(), location(name), 1, &value[0]);
}
void program::set(const char* name, glm::vec3 value) const {
    glProgramUniform3fv(id(), location(name), 1, &value[0]);
}
void program::set(const char* name, glm::vec4 value) const {
    glProgramUniform4fv(id(), location(name), 1, &value[0]);
}
void program::set(const char* name, const glm::mat3& value) const {
    glProgramUniformMatrix3fv(id(), location(name), 1, GL_FALSE, &value[0][0]);
}
void program::set(const char* name, const glm::mat4& value) const {
    glProgramUniformMatrix4fv(id(), location(name), 1, GL_FALSE, &value[0][0]);
}

} // namespace gl
