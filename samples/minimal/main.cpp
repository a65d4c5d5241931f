// A warped shadow map in a bare OpenGL program. Usage: minimal [--plain] [--png FILE]
#include <warpshadow/fit.hpp>
#include <warpshadow/frustum.hpp>
#include <warpshadow/glsl.hpp>
#include <warpshadow/light.hpp>
#include <warpshadow/warp_build.hpp>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <glm/glm.hpp>
#include <stb/stb_image_write.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace ws = warpshadow;

constexpr int map_size = 512, width = 1024, height = 640;
constexpr int sample_width = 256, sample_height = 160; // of the depth that is read back

[[noreturn]] static void fail(const std::string& why) {
    std::fprintf(stderr, "minimal: %s\n", why.c_str());
    std::exit(1);
}

// A parallelogram of n x n cells: a warped map bends straight edges, so none may be long.
static void add_patch(std::vector<glm::vec3>& out, glm::vec3 corner, glm::vec3 a, glm::vec3 b,
                      int n) {
    a /= float(n);
    b /= float(n);
    for (int i = 0; i < n * n; ++i) {
        const glm::vec3 p = corner + a * float(i % n) + b * float(i / n);
        out.insert(out.end(), {p, p + a, p + a + b, p, p + a + b, p + b});
    }
}

static std::vector<glm::vec3> make_scene() {
    std::vector<glm::vec3> out;
    add_patch(out, {-30, 0, 15}, {60, 0, 0}, {0, 0, -60}, 240); // the ground
    for (int i = 0; i < 24; ++i) {                              // two rows of posts
        const glm::vec3 foot(i % 2 == 0 ? -3.3f : 2.7f, 0, 8.3f - 3.0f * float(i / 2));
        const glm::vec3 x(0.6f, 0, 0), y(0, 2.6f, 0), z(0, 0, -0.6f);
        add_patch(out, foot, x, y, 8);
        add_patch(out, foot + x, z, y, 8);
        add_patch(out, foot + x + z, -x, y, 8);
        add_patch(out, foot + z, -z, y, 8);
        add_patch(out, foot + y, x, z, 8);
    }
    for (int i = 0; i < 30; ++i) { // rails between them
        const glm::vec3 end(i % 2 == 0 ? -3 : 3, 0.5f + 0.4f * float(i / 2 % 5), 8 - 11 * (i / 10));
        add_patch(out, end, {0, 0, -11}, {0, 0.1f, 0}, 48);
    }
    return out;
}

// A shader file with the functions of the library that it uses in front of it.
static void attach(GLuint program, GLenum type, const std::string& file) {
    std::stringstream body;
    body << std::ifstream(std::string(MINIMAL_SHADERS) + file).rdbuf();
    const std::string text =
        "#version 330 core\n" + ws::glsl::emit({"warp", "unwarp", "warp_clip"}).text + body.str();
    const char* source = text.c_str();
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled == 0) {
        fail(file + " does not compile");
    }
}

static GLuint make_texture(GLenum format, int w, int h) {
    GLuint id = 0;
    glGenTextures(1, &id);
    glBindTexture(GL_TEXTURE_2D, id);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, w, h);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return id;
}

static GLuint make_target(GLuint colour, GLuint depth) {
    GLuint id = 0;
    glGenFramebuffers(1, &id);
    glBindFramebuffer(GL_FRAMEBUFFER, id);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    return id;
}

class renderer {
  public:
    renderer()
        : scene_(make_scene()), program_(glCreateProgram()), counts_(map_size * map_size),
          scratch_(map_size), row_nodes_(map_size * (map_size + 1)), column_nodes_(row_nodes_) {
        attach(program_, GL_VERTEX_SHADER, "scene.vert");
        attach(program_, GL_FRAGMENT_SHADER, "scene.frag");
        glLinkProgram(program_);
        glUseProgram(program_);
        GLuint array = 0, buffer = 0;
        glGenVertexArrays(1, &array);
        glBindVertexArray(array);
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(scene_.size() * sizeof scene_[0]), scene_.data(),
                     GL_STATIC_DRAW);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
        glEnableVertexAttribArray(0);
        seen_ = make_target(0, make_texture(GL_DEPTH_COMPONENT32F, sample_width, sample_height));
        map_ = make_texture(GL_DEPTH_COMPONENT32F, map_size, map_size);
        map_target_ = make_target(0, map_);
        rows_ = make_texture(GL_R32F, map_size + 1, map_size);
        columns_ = make_texture(GL_R32F, map_size + 1, map_size);
        glEnable(GL_DEPTH_TEST);
    }

    void frame(GLuint target, float sun_angle, bool warped) {
        const ws::clip_space clip = ws::clip::opengl;
        const auto volume =
            ws::perspective_volume(1.0f, float(width) / float(height), 0.1f, 120.0f);
        const auto eye =
            ws::make_frustum<float>({0.6f, 1.7f, 14}, {0, -0.08f, -1}, {0, 1, 0}, volume);
        const glm::mat4 camera =
            ws::projection_matrix(volume, clip) * ws::view_matrix(eye.value, clip);
        const glm::vec3 sunlight(std::cos(sun_angle), -0.75f, std::sin(sun_angle));
        glm::mat4 light =
            ws::directional_light_matrix(ws::sun(sunlight), {{-30, 0, -45}, {30, 3, 15}}, clip)
                .matrix;
        const glm::vec3 to_sun = -glm::normalize(sunlight);
        glUniform3fv(uniform("to_sun"), 1, &to_sun[0]);
        glUniformMatrix4fv(uniform("camera"), 1, GL_FALSE, &camera[0][0]);
        // 1. what the camera sees, as points of the light's map
        draw(seen_, sample_width, sample_height, false);
        std::vector<float> depth(sample_width * sample_height);
        glReadPixels(0, 0, sample_width, sample_height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
        std::vector<glm::vec2> samples;
        const glm::mat4 map_from_view = light * glm::inverse(camera);
        for (int i = 0; i < sample_width * sample_height; ++i) {
            const float x = float(i % sample_width) + 0.5f, y = float(i / sample_width) + 0.5f;
            const glm::vec3 seen(x / sample_width, y / sample_height, depth[std::size_t(i)]);
            const glm::vec4 p = map_from_view * glm::vec4(2.0f * seen - 1.0f, 1.0f);
            if (seen.z < 1.0f) { // 1 is the sky
                samples.push_back(ws::map_from_ndc(glm::vec2(p) / p.w, clip));
            }
        }
        // 2. the map's rectangle, the functions that move its texels to the samples, the map
        const std::span<const glm::vec2> all(samples);
        const auto seen = ws::desired_view(all, 0.5f / (map_size - 1));
        light = ws::crop_matrix(light, seen.rect).matrix;
        for (glm::vec2& p : samples) {
            p = ws::crop(seen.rect, p);
        }
        const float floor = warped ? 0.25f : 1.0f; // a floor of 1 leaves nothing to warp
        ws::build_warp<float, float>(all, {.window = 0.4f, .floor = floor},
                                     {map_size, counts_, scratch_, row_nodes_, column_nodes_});
        for (const int unit : {1, 2}) {
            glActiveTexture(GL_TEXTURE0 + GLenum(unit));
            glBindTexture(GL_TEXTURE_2D, unit == 1 ? rows_ : columns_);
            glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, map_size + 1, map_size, GL_RED, GL_FLOAT,
                            unit == 1 ? row_nodes_.data() : column_nodes_.data());
            glUniform1i(uniform(unit == 1 ? "rows" : "columns"), unit);
        }
        glUniformMatrix4fv(uniform("light"), 1, GL_FALSE, &light[0][0]);
        draw(map_target_, map_size, map_size, true);
        // 3. the picture
        glActiveTexture(GL_TEXTURE3);
        glBindTexture(GL_TEXTURE_2D, map_);
        glUniform1i(uniform("shadow_map"), 3);
        draw(target, width, height, false);
        glUniform1i(uniform("shadow_map"), 0); // a map is not read while it is drawn
    }

  private:
    GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }

    void draw(GLuint target, int w, int h, bool into_map) const {
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        glViewport(0, 0, w, h);
        glClearColor(0.62f, 0.75f, 0.88f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glUniform1i(uniform("into_map"), into_map ? 1 : 0);
        glDrawArrays(GL_TRIANGLES, 0, GLsizei(scene_.size()));
    }

    std::vector<glm::vec3> scene_;
    GLuint program_, seen_ = 0, map_ = 0, rows_ = 0, columns_ = 0, map_target_ = 0;
    std::vector<std::uint32_t> counts_;
    std::vector<std::uint64_t> scratch_;
    std::vector<float> row_nodes_, column_nodes_;
};

static void write_png(const char* file, bool warped) {
    const EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    eglInitialize(display, nullptr, nullptr);
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
        fail("no OpenGL 3.3 context through EGL");
    }
    const GLuint target = make_target(make_texture(GL_RGBA8, width, height),
                                      make_texture(GL_DEPTH_COMPONENT32F, width, height));
    renderer().frame(target, 0.6f, warped);
    std::vector<unsigned char> pixels(3 * width * height);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    stbi_flip_vertically_on_write(1);
    if (stbi_write_png(file, width, height, 3, pixels.data(), 3 * width) == 0) {
        fail(std::string("cannot write ") + file);
    }
}

static void open_window(bool warped) {
    glfwInit();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* window = glfwCreateWindow(width, height, "warpshadow: minimal", nullptr, nullptr);
    if (window == nullptr) {
        fail("no window with OpenGL 3.3 here; --png FILE writes a picture without one");
    }
    glfwMakeContextCurrent(window);
    renderer scene;
    while (glfwWindowShouldClose(window) == GLFW_FALSE) { // the space bar shows the other map
        const bool other = glfwGetKey(window, GLFW_KEY_SPACE) == GLFW_PRESS;
        scene.frame(0, 0.6f + 0.1f * float(glfwGetTime()), warped != other);
        glfwSwapBuffers(window);
        glfwPollEvents();
    }
}

int main(int argc, char** argv) {
    bool warped = true;
    const char* png = nullptr;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--plain") {
            warped = false;
        } else if (argument == "--png" && i + 1 < argc) {
            png = argv[++i];
        } else {
            fail("usage: minimal [--plain] [--png FILE]");
        }
    }
    png != nullptr ? write_png(png, warped) : open_window(warped);
}
