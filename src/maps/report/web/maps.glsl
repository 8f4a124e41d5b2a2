// The model of a texel, as src/maps/engine/model.h defines it, under one distant light.
uniform sampler2D normals, diffuses, mirrors, lasts;  // n and whether there is a lobe; diffuse, a; f0, b; c
uniform vec3 light;
uniform float schlick, exposure;
out vec4 color;

// With the soft shoulder that the report's photographs have (plot/color.h).
float screen(float v) {
  v = max(v * exposure, 0.0);
  if (v > 0.7) v = 0.7 + 0.3 * (1.0 - exp(-(v - 0.7) / 0.3));
  return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

// u_z + sqrt(u_z^2 + q1^2 + q2^2) with the widths a, b, c.
float sum(vec3 w, vec3 u) { return u.z + length(vec3(u.z, w.x * u.x + w.y * u.y, w.z * u.y)); }

void main() {
  ivec2 size = textureSize(normals, 0), at = ivec2(int(gl_FragCoord.x), size.y - 1 - int(gl_FragCoord.y));
  vec4 n = texelFetch(normals, at, 0);
  if (n.w < 0.0) { color = vec4(0.0); return; }
  vec4 diffuse = texelFetch(diffuses, at, 0), f0 = texelFetch(mirrors, at, 0);
  vec3 w = vec3(diffuse.w, f0.w, texelFetch(lasts, at, 0).x);
  n.xyz = normalize(n.xyz);
  // The frame of the shortest turn from z to n.
  float q = 1.0 / (1.0 + n.z);
  vec3 t = vec3(1.0 - n.x * n.x * q, -n.x * n.y * q, -n.x), b = vec3(-n.x * n.y * q, 1.0 - n.y * n.y * q, -n.y);
  vec3 i = vec3(dot(t, light), dot(b, light), dot(n.xyz, light)), o = vec3(t.z, b.z, n.z);
  if (i.z <= 0.0) { color = vec4(0.0, 0.0, 0.0, 1.0); return; }
  vec3 value = diffuse.rgb * 0.3183098862 * i.z;
  if (n.w > 0.0) {
    vec3 h = i + o;
    float y1 = -h.x / w.x, y2 = (-h.y - w.y * y1) / w.z, k = h.z * h.z + y1 * y1 + y2 * y2, square = dot(h, h);
    float specular = i.z * square * square / (3.1415926536 * w.x * w.z * k * k * sum(w, i) * sum(w, o));
    float rest = schlick * pow(max(0.0, 1.0 - 0.5 * sqrt(square)), 5.0);
    value += (f0.rgb * (1.0 - rest) + rest) * specular;
  }
  color = vec4(screen(value.r), screen(value.g), screen(value.b), 1.0);
}
