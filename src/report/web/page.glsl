// Fragment shader of the page: the sphere of the fit, the measured one, and values of f_r for the slice. It stands behind the version,
// the precision of numbers and the functions of lobe.glsl.
precision highp sampler2D;
precision highp sampler3D;
in vec2 at;
out vec4 color;
uniform int mode;            // 0: sphere of the fit, 1: measured sphere, 2: values of f_r
uniform int lobes;
uniform int channels;
uniform vec4 shape[8];       // mean slope x, y; a, b of the Cholesky factor
uniform vec4 kind[8];        // c; family; masking; Fresnel: 0 Schlick, 1 conductor, 2 dielectric, 3 scale, 4 tinted, 5 curve,
                             // 6 and 7 the surface of a coat, layered and refracted
uniform vec4 radial[8];      // 0 or the number of nodes of the ratio; pieces of the excess, 0 for Student's; gamma, or g of ABg; 1: retro
uniform int coat;            // the lobe that is a coat over the others; -1: none
uniform int diffuseKind;     // 0: none, 1: Lambert, 2: facets, 3: interfaced, 4: Oren-Nayar
// Rows 2 l and 2 l + 1, column c: parameters of lobe l's Fresnel term in channel c; rows from 2 `lobes`: diffuse albedo,
// then red, green, blue of the channel; and the diffuse part's index or roughness.
uniform sampler2D parameters;
// Row l of a radial lobe: the tail of the ratio (its logarithm, slope and bend, and where it begins); step of the
// nodes; then for each piece of the excess its left end and its cubic; then value and slope of the ratio at each node.
uniform sampler2D profiles;
uniform sampler2D pairs;     // column i: wi, wo
uniform vec3 light;
uniform float exposure;
uniform float texel;         // size of a pixel in units of the radius
uniform sampler3D table;
uniform vec3 tableSize;
const float PI = 3.14159265358979;
// The rule of diffuse_facets.h with 12 radii by 24 angles: radii, and share of the density at each of the 24 nodes.
const float GGX_RADII[12] = float[12](
  0.0144832566, 0.0754488084, 0.182711419, 0.335967826, 0.54177173, 0.820372051,
  1.21895913, 1.84579583, 2.97647549, 5.47311168, 13.2540198, 69.0452452);
const float GGX_SHARES[12] = float[12](
  4.47093931e-05, 0.000525089389, 0.00185244516, 0.00401434099, 0.00640067784, 0.00799607057,
  0.00799607057, 0.00640067784, 0.00401434099, 0.00185244516, 0.000525089389, 4.47093931e-05);
const float BECKMANN_RADII[12] = float[12](
  0.0553180973, 0.287648231, 0.690291977, 1.23804614, 1.8965055, 2.62429977,
  3.37570023, 4.1034945, 4.76195386, 5.30970802, 5.71235177, 5.9446819);
const float BECKMANN_SHARES[12] = float[12](
  0.000650419071, 0.00707953902, 0.0171538949, 0.0135788338, 0.00303476992, 0.000166895687,
  2.36494544e-06, 1.16527028e-08, 3.43106343e-11, 1.21137658e-13, 1.029071e-15, 3.14880262e-17);
// Lambertian facets of the first lobe, albedo 1.
float facets(vec3 wi, vec3 wo, vec3 h) {
  vec4 s = shape[0];
  float c = kind[0].x, sum = 0.0;
  int family = int(kind[0].y);
  for (int k = 0; k < 48; ++k) {
    float phi = 2.0 * PI * float(k) / 48.0;
    vec2 along = vec2(s.z * cos(phi), s.w * cos(phi) + c * sin(phi));
    // <m.u> = z - mean . u - radius (along . u)
    float zo = wo.z - dot(s.xy, wo.xy), zi = wi.z - dot(s.xy, wi.xy), go = dot(along, wo.xy), gi = dot(along, wi.xy);
    for (int i = k % 2; i < 12; i += 2) {
      float radius = family == 1 ? BECKMANN_RADII[i] : GGX_RADII[i];
      vec2 slope = s.xy + radius * along;
      sum += (family == 1 ? BECKMANN_SHARES[i] : GGX_SHARES[i]) * max(zo - radius * go, 0.0) *
             max(zi - radius * gi, 0.0) * inversesqrt(1.0 + dot(slope, slope));
    }
  }
  return sum / (PI * lobefit_area(wi, wo, h, s.x, s.y, s.z, s.w, c, family, int(kind[0].z), 1.0, 1.0));
}
float excessOf(int k, float u) {
  if (radial[k].y == 0.0) return 2.0 * u - radial[k].z * log(1.0 + (exp(u) - 1.0) / (radial[k].z - 1.0));
  int piece = 0;
  for (int i = 1; i < int(radial[k].y); ++i) {
    if (u >= texelFetch(profiles, ivec2(2 + 2 * i, k), 0).x) piece = i;
  }
  float x = u - texelFetch(profiles, ivec2(2 + 2 * piece, k), 0).x;
  vec4 c = texelFetch(profiles, ivec2(3 + 2 * piece, k), 0);
  return c.x + x * (c.y + x * (c.z + x * c.w));
}
float ratioOf(int k, float w) {
  vec4 tail = texelFetch(profiles, ivec2(0, k), 0);
  if (w >= tail.w) return exp(tail.x + tail.y * (w - tail.w) + tail.z * exp(-2.0 * w));
  float step = texelFetch(profiles, ivec2(1, k), 0).x, position = w / step;
  int node = min(int(position), int(radial[k].x) - 2), first = 2 + 2 * int(radial[k].y);
  float t = position - float(node), s = 1.0 - t;
  vec4 a = texelFetch(profiles, ivec2(first + node, k), 0), b = texelFetch(profiles, ivec2(first + node + 1, k), 0);
  return s * s * (1.0 + 2.0 * t) * a.x + t * t * (1.0 + 2.0 * s) * b.x + step * s * t * (s * a.y - t * b.y);
}
// What all channels share: the two directions, the diffuse part of albedo 1 and each lobe without its Fresnel term.
vec3 toLight, toViewer;
float diffusePart;
float cosD[8];
float lobePart[8];
void prepare(vec3 wi, vec3 wo) {
  toLight = wi;
  toViewer = wo;
  vec3 h = normalize(wi + wo), insideI = wi, insideO = wo;
  if (coat >= 0 && kind[coat].w == 7.0) {
    float ior = texelFetch(parameters, ivec2(0, 2 * coat), 0).x;
    insideI = lobefit_refracted(wi, ior);
    insideO = lobefit_refracted(wo, ior);
  }
  for (int k = 0; k < 8; ++k) {
    if (k >= lobes) break;
    vec3 ki = k == coat ? wi : insideI, ko = k == coat ? wo : insideO;
    vec4 s = shape[k];
    float c = kind[k].x, excess = 0.0, ratioI = 1.0, ratioO = 1.0;
    vec3 i = radial[k].w > 0.0 ? vec3(-ki.xy, ki.z) : ki, own = normalize(i + ko);
    if (radial[k].x > 0.0) {
      excess = excessOf(k, lobefit_u(own, s.x, s.y, s.z, s.w, c));
      ratioI = ratioOf(k, lobefit_w(i, s.x, s.y, s.z, s.w, c));
      ratioO = ratioOf(k, lobefit_w(ko, s.x, s.y, s.z, s.w, c));
    }
    if (kind[k].y == 2.0) excess = radial[k].z;
    cosD[k] = dot(i, own);
    lobePart[k] = lobefit_lobe(i, ko, own, s.x, s.y, s.z, s.w, c, int(kind[k].y), int(kind[k].z), excess, ratioI, ratioO);
  }
  diffusePart = diffuseKind == 1 ? 1.0 / PI : diffuseKind == 2 ? facets(wi, wo, h) : 0.0;
}
float fresnel(int kindOf, float c, vec4 p, vec2 q) {
  if (kindOf == 0) return p.x + (1.0 - p.x) * lobefit_schlick(c);
  if (kindOf == 1) return lobefit_conductor(c, p.x, p.y);
  if (kindOf == 2 || kindOf > 5) return lobefit_dielectric(c, p.x);
  if (kindOf == 4) return lobefit_schlick_f82(c, p.x, p.y);
  if (kindOf == 5) return lobefit_curve(c, p.x, p.y, p.z, p.w, q.x, q.y);
  return p.x;
}
float channelValue(int channel) {
  float albedo = texelFetch(parameters, ivec2(channel, 2 * lobes), 0).x, f = albedo * diffusePart;
  if (diffuseKind > 2) {
    float own = texelFetch(parameters, ivec2(channel, 2 * lobes + 1), 0).x;
    f = diffuseKind == 3 ? lobefit_interfaced(toLight, toViewer, own, albedo) : lobefit_oren_nayar(toLight, toViewer, own, albedo);
  }
  vec4 layer = coat < 0 ? vec4(0.0) : texelFetch(parameters, ivec2(channel, 2 * coat), 0);
  float bends = coat >= 0 && kind[coat].w == 7.0 ? 1.0 : 0.0;
  if (coat >= 0) f *= PI * lobefit_below(bends, layer.x);
  for (int k = 0; k < 8; ++k) {
    if (k >= lobes) break;
    if (k == coat) continue;
    f += lobePart[k] * fresnel(int(kind[k].w), cosD[k], texelFetch(parameters, ivec2(channel, 2 * k), 0),
                               texelFetch(parameters, ivec2(channel, 2 * k + 1), 0).xy);
  }
  if (coat < 0) return f;
  return f * lobefit_through(toLight, toViewer, bends, layer.x, layer.y) + lobePart[coat] * fresnel(6, cosD[coat], layer, vec2(0.0));
}
vec3 fitted(vec3 wi, vec3 wo) {
  prepare(wi, wo);
  vec3 sum = vec3(0.0);
  for (int c = 0; c < channels; ++c) sum += channelValue(c) * texelFetch(parameters, ivec2(c, 2 * lobes), 0).yzw;
  return sum;
}
vec4 fromTable(vec3 wi, vec3 wo) {
  vec3 h = normalize(wi + wo);
  float th = atan(length(h.xy), h.z), ph = atan(h.y, h.x);
  vec3 a = vec3(cos(ph) * wi.x + sin(ph) * wi.y, -sin(ph) * wi.x + cos(ph) * wi.y, wi.z);
  vec3 d = vec3(cos(th) * a.x - sin(th) * a.z, a.y, sin(th) * a.x + cos(th) * a.z);
  float td = atan(length(d.xy), d.z), pd = abs(atan(d.y, d.x));
  if (pd > PI / 2.0) pd = PI - pd;
  vec3 t = vec3(sqrt(th / (PI / 2.0)), td / (PI / 2.0), pd / (PI / 2.0));
  vec4 v = texture(table, (t * (tableSize - 1.0) + 0.5) / tableSize);
  return vec4(exp(v.rgb), v.a);
}
float screen(float v) {
  float x = max(0.0, v * exposure), knee = 0.7;
  if (x > knee) x = knee + (1.0 - knee) * (1.0 - exp(-(x - knee) / (1.0 - knee)));
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}
// The bits of one number as the bytes of a pixel, which every browser can read back.
vec4 bytesOf(float v) {
  uint bits = floatBitsToUint(v);
  return vec4(bits & 255u, bits >> 8 & 255u, bits >> 16 & 255u, bits >> 24) / 255.0;
}
void main() {
  if (mode == 2) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 wi = texelFetch(pairs, ivec2(pixel.x, 0), 0).xyz, wo = texelFetch(pairs, ivec2(pixel.x, 1), 0).xyz;
    float value = 0.0;
    if (wi.z > 0.0 && wo.z > 0.0) {
      prepare(wi, wo);
      value = channelValue(pixel.y);
    }
    color = bytesOf(value);
    return;
  }
  float r = length(at);
  if (r > 1.0 + texel) { color = vec4(1.0); return; }
  vec2 p = r > 0.999 ? at * (0.999 / r) : at;
  vec3 n = vec3(p, sqrt(1.0 - dot(p, p)));
  vec3 x = normalize(cross(vec3(0.0, 1.0, 0.0), n)), y = cross(n, x);
  vec3 wi = vec3(dot(light, x), dot(light, y), dot(light, n)), wo = vec3(x.z, y.z, n.z);
  vec3 radiance = vec3(0.0);
  vec3 shown;
  bool known = true;
  if (wi.z > 0.0) {
    if (mode == 1) {
      vec4 v = fromTable(wi, wo);
      known = v.a > 0.5;
      radiance = v.rgb;
    } else {
      radiance = fitted(wi, wo);
    }
    radiance *= wi.z * PI;
  }
  shown = known ? vec3(screen(radiance.r), screen(radiance.g), screen(radiance.b)) : vec3(0.815, 0.835, 0.858);
  float inside = clamp((1.0 - r) / texel + 0.5, 0.0, 1.0);
  color = vec4(mix(vec3(1.0), shown, inside), 1.0);
}
