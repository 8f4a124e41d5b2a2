// Shaders in OpenGL ES 3 without a window, on Mesa's llvmpipe where there is no graphics card:
//   gles VERTEX FRAGMENT [UNIFORMS] < rows
// One pixel a row, which begins with theta_i, phi_i, theta_o, phi_o in degrees. The surface is the plane z = 0 with
// tangent x. A fragment shader has `uniform vec3 light, viewer` and gives f_r, or it is MaterialX', under one
// directional light, and gives f_r times the cosine of the light. UNIFORMS: type, name, value, a line each. Prints f_r,
// one line a row; the renderer's name on standard error.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <EGL/egl.h>
#include <GLES3/gl3.h>

namespace {

using Vector = std::array<float, 3>;

[[noreturn]] void Fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::exit(1);
}

Vector Direction(double theta_deg, double phi_deg) {
  const double theta = theta_deg * M_PI / 180, phi = phi_deg * M_PI / 180;
  return {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::sin(theta) * std::sin(phi)),
          static_cast<float>(std::cos(theta))};
}

void StartGl() {
  EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (!eglInitialize(display, nullptr, nullptr)) Fail("no EGL");
  eglBindAPI(EGL_OPENGL_ES_API);
  const EGLint want[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, want, &config, 1, &count) || count == 0) Fail("no OpenGL ES 3");
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) Fail("no context without a surface");
  std::fprintf(stderr, "%s\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
}

void Attach(GLuint program, GLenum kind, const char* path) {
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const char* start = text.c_str();
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &start, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == 0) {
    std::array<char, 4096> log = {};
    glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    Fail(std::string(path) + ": " + log.data());
  }
  glAttachShader(program, shader);
}

class Program {
 public:
  Program(const char* vertex, const char* fragment) : program_(glCreateProgram()) {
    Attach(program_, GL_VERTEX_SHADER, vertex);
    Attach(program_, GL_FRAGMENT_SHADER, fragment);
    glLinkProgram(program_);
    GLint linked = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (linked == 0) Fail("the shaders do not link");
    glUseProgram(program_);
  }

  GLint Place(const std::string& name) const { return glGetUniformLocation(program_, name.c_str()); }
  GLint Attribute(const char* name) const { return glGetAttribLocation(program_, name); }
  void Set(const std::string& name, const Vector& v) const { glUniform3fv(Place(name), 1, v.data()); }

  void SetAttribute(const char* name, const Vector& v) const {
    if (Attribute(name) >= 0) glVertexAttrib3fv(static_cast<GLuint>(Attribute(name)), v.data());
  }

  // A line of UNIFORMS; what the shader does not use has no place, and setting it does nothing.
  void Set(const std::string& line) const {
    std::istringstream fields(line);
    std::string type, name, word;
    fields >> type >> name;
    std::vector<float> numbers;
    while (fields >> word) numbers.push_back(word == "true" ? 1 : std::strtof(word.c_str(), nullptr));
    if (type == "integer" || type == "boolean") {
      glUniform1i(Place(name), static_cast<GLint>(numbers.at(0)));
    } else if (numbers.size() == 1) {
      glUniform1f(Place(name), numbers[0]);
    } else if (numbers.size() == 2) {
      glUniform2fv(Place(name), 1, numbers.data());
    } else if (numbers.size() == 3) {
      glUniform3fv(Place(name), 1, numbers.data());
    } else {
      Fail("not understood: " + line);
    }
  }

 private:
  GLuint program_;
};

// The surface: a triangle over the pixel, the middle of which is the origin.
void SetSurface(const Program& program) {
  static constexpr float kCorners[] = {-1, -1, 0, 3, -1, 0, -1, 3, 0};
  static constexpr float kIdentity[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  for (const char* name : {"u_worldMatrix", "u_worldInverseTransposeMatrix", "u_viewProjectionMatrix", "u_envMatrix"}) {
    glUniformMatrix4fv(program.Place(name), 1, GL_FALSE, kIdentity);
  }
  const auto position = static_cast<GLuint>(program.Attribute("i_position"));
  glEnableVertexAttribArray(position);
  glVertexAttribPointer(position, 3, GL_FLOAT, GL_FALSE, 0, kCorners);
  program.SetAttribute("i_tangent", {1, 0, 0});
  program.SetAttribute("i_normal", {0, 0, 1});
}

// One row of pixels in floating point.
void StartPicture(GLsizei width) {
  GLuint texture = 0, frame = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, width, 1);
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  glBindTexture(GL_TEXTURE_2D, 0);  // an environment without a texture is black, and is not this picture
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) Fail("no picture in floating point");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3 && count != 4) return 2;
  StartGl();
  const Program program(arguments[1], arguments[2]);
  SetSurface(program);
  if (count == 4) {
    std::ifstream file(arguments[3]);
    for (std::string line; std::getline(file, line);) program.Set(line);
  }
  const bool lit = program.Place("u_lightData[0].type") >= 0;
  glUniform1i(program.Place("u_numActiveLightSources"), 1);
  glUniform1i(program.Place("u_lightData[0].type"), 1);
  glUniform1f(program.Place("u_lightData[0].intensity"), 1);
  program.Set("u_lightData[0].color", Vector{1, 1, 1});

  std::vector<std::array<double, 4>> rows;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream fields(line);
    auto& [theta_i, phi_i, theta_o, phi_o] = rows.emplace_back();
    if (!(fields >> theta_i >> phi_i >> theta_o >> phi_o)) Fail("not a row: " + line);
  }
  StartPicture(static_cast<GLsizei>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vector light = Direction(rows[k][0], rows[k][1]), viewer = Direction(rows[k][2], rows[k][3]);
    program.Set("light", light);
    program.Set("viewer", viewer);
    program.Set("u_viewPosition", viewer);
    program.Set("u_lightData[0].direction", Vector{-light[0], -light[1], -light[2]});
    glViewport(static_cast<GLint>(k), 0, 1, 1);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  std::vector<std::array<float, 4>> pixels(rows.size());
  glReadPixels(0, 0, static_cast<GLsizei>(rows.size()), 1, GL_RGBA, GL_FLOAT, pixels.data());
  if (glGetError() != GL_NO_ERROR) Fail("an error of OpenGL");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double factor = lit ? 1 / static_cast<double>(Direction(rows[k][0], 0)[2]) : 1;
    std::printf("%.9g %.9g %.9g\n", factor * static_cast<double>(pixels[k][0]),
                factor * static_cast<double>(pixels[k][1]), factor * static_cast<double>(pixels[k][2]));
  }
  return 0;
}
