// The model of a texel, as src/maps/engine/model.h defines it, under one light.
uniform sampler2D normals, diffuses, mirrors, lasts;  // n and whether there is a lobe; diffuse, a; f0, b; c, mean slopes
uniform vec4 light, camera;  // w 0: where it is, as a direction; 1: its place, mm
uniform vec4 grid;           // mm a texel, texels a step, half the picture's width and height in texels
uniform vec2 fall;           // of a near light: square of the distance that its intensity is of (0: of all), exponent
uniform float schlick, exposure;
out vec4 color;

// With the soft shoulder that the report's photographs have (plot/color.h).
float screen(float v) {
  v = max(v * exposure, 0.0);
  if (v > 0.7) v = 0.7 + 0.3 * (1.0 - exp(-(v - 0.7) / 0.3));
  return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}

// c + sqrt(c^2 + q1^2 + q2^2), c = u_z - s . u, with the widths a, b, c; at least 2 u_z.
float sum(vec3 w, vec2 s, vec3 u) {
  float c = u.z - dot(s, u.xy);
  return max(2.0 * u.z, c + length(vec3(c, w.x * u.x + w.y * u.y, w.z * u.y)));
}

void main() {
  ivec2 size = textureSize(normals, 0), at = ivec2(int(gl_FragCoord.x), size.y - 1 - int(gl_FragCoord.y));
  vec4 n = texelFetch(normals, at, 0);
  if (n.w < 0.0) { color = vec4(0.0); return; }
  vec4 diffuse = texelFetch(diffuses, at, 0), f0 = texelFetch(mirrors, at, 0), last = texelFetch(lasts, at, 0);
  vec3 w = vec3(diffuse.w, f0.w, last.x);
  vec2 cell = vec2(at) * grid.y + 0.5;
  vec3 point = grid.x * vec3(cell.x - grid.z, grid.w - cell.y, 0.0);
  vec3 beam = light.xyz - light.w * point, wi = normalize(beam), wo = normalize(camera.xyz - camera.w * point);
  float irradiance = 1.0;
  if (light.w > 0.0 && fall.x > 0.0) irradiance = fall.x / dot(beam, beam);
  // Its axis points to the middle.
  if (light.w > 0.0 && fall.y > 0.0) irradiance *= pow(max(0.0, dot(wi, normalize(light.xyz))), fall.y);
  n.xyz = normalize(n.xyz);
  // The frame of the shortest turn from z to n.
  float q = 1.0 / (1.0 + n.z);
  vec3 t = vec3(1.0 - n.x * n.x * q, -n.x * n.y * q, -n.x), b = vec3(-n.x * n.y * q, 1.0 - n.y * n.y * q, -n.y);
  vec3 i = vec3(dot(t, wi), dot(b, wi), dot(n.xyz, wi)), o = vec3(dot(t, wo), dot(b, wo), dot(n.xyz, wo));
  if (i.z <= 0.0) { color = vec4(0.0, 0.0, 0.0, 1.0); return; }
  vec3 value = diffuse.rgb * 0.3183098862 * i.z;
  if (n.w > 0.0 && o.z > 0.0) {
    vec3 h = i + o;
    float y1 = -(h.x + last.y * h.z) / w.x, y2 = (-(h.y + last.z * h.z) - w.y * y1) / w.z, k = h.z * h.z + y1 * y1 + y2 * y2, square = dot(h, h);
    float specular = i.z * square * square / (3.1415926536 * w.x * w.z * k * k * sum(w, last.yz, i) * sum(w, last.yz, o));
    float rest = schlick * pow(max(0.0, 1.0 - 0.5 * sqrt(square)), 5.0);
    value += (f0.rgb * (1.0 - rest) + rest) * specular;
  }
  value *= irradiance;
  color = vec4(screen(value.r), screen(value.g), screen(value.b), 1.0);
}
