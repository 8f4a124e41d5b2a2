#include "lobefit/maps/output/planes.h"

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

double Degrees(double radians) { return radians * 180 / kPi; }

}  // namespace

const char* PartName(MapPart part) {
  return part == MapPart::kParameters ? "parameters" : part == MapPart::kErrors ? "errors" : "quality";
}

std::vector<MapPlane> PlanesFor(const MapKind& kind) {
  const MapLobe lobe = kind.lobe;
  const int channels = kind.channels;
  std::vector<MapPlane> planes;
  const auto amplitudes = [&](MapPart part, MapType type, const char* head) {
    for (int c = 0; c < channels; ++c) {
      planes.push_back({part, std::string(head) + (channels == 1 ? "Y" : std::string(1, "RGB"[c])), type});
    }
  };
  for (const MapPart part : {MapPart::kParameters, MapPart::kErrors}) {
    const bool errors = part == MapPart::kErrors;
    const MapType type = errors ? MapType::kHalf : MapType::kFloat;
    for (const char* name : {"normal.x", "normal.y", "normal.z"}) planes.push_back({part, name, type});
    if (errors) planes.push_back({part, "normal.angle_deg", type});
    amplitudes(part, type, "diffuse.");
    if (lobe == MapLobe::kNone) continue;
    amplitudes(part, type, "f0.");
    const std::string alpha = errors ? "ln_alpha" : "alpha";
    if (lobe == MapLobe::kGgx) planes.push_back({part, alpha, type});
    if (lobe == MapLobe::kGgx) continue;
    for (const std::string& name : {alpha + "_x", alpha + "_y", std::string("angle_deg")}) {
      planes.push_back({part, name, type});
    }
    if (lobe != MapLobe::kEllipsoid) continue;
    for (const char* name : {"tilt_x_deg", "tilt_y_deg"}) planes.push_back({part, name, type});
  }
  if (kind.doubt) planes.push_back({MapPart::kQuality, "normal.doubt_deg", MapType::kFloat});
  planes.push_back({MapPart::kQuality, "rms", MapType::kFloat});
  planes.push_back({MapPart::kQuality, "scale", MapType::kFloat});
  planes.push_back({MapPart::kQuality, "used", MapType::kHalf});
  if (kind.clusters) planes.push_back({MapPart::kQuality, "cluster", MapType::kCount});
  planes.push_back({MapPart::kQuality, "status", MapType::kCount});
  return planes;
}

void Fill(const TexelFit& fit, const MapKind& kind, float* values) {
  const MapLobe lobe = kind.lobe;
  const int channels = kind.channels;
  std::size_t at = 0;
  const auto put = [&](double value) { values[at++] = static_cast<float>(value); };
  for (const bool errors : {false, true}) {
    const Vec3& normal = errors ? fit.normal_error : fit.normal;
    put(normal.x), put(normal.y), put(normal.z);
    if (errors) put(Degrees(fit.normal_angle_error));
    for (int c = 0; c < channels; ++c) put(errors ? fit.diffuse_error[c] : fit.diffuse[c]);
    if (lobe == MapLobe::kNone) continue;
    for (int c = 0; c < channels; ++c) put(errors ? fit.f0_error[c] : fit.f0[c]);
    put(errors ? fit.log_alpha_x_error : fit.alpha_x);
    if (lobe == MapLobe::kGgx) continue;
    put(errors ? fit.log_alpha_y_error : fit.alpha_y);
    put(Degrees(errors ? fit.angle_error : fit.angle));
    for (int k = 0; k < 2 && lobe == MapLobe::kEllipsoid; ++k) put(Degrees(errors ? fit.tilt_error[k] : fit.tilt[k]));
  }
  if (kind.doubt) put(Degrees(fit.normal_doubt));
  put(fit.rms), put(fit.scale), put(fit.used);
  if (kind.clusters) put(fit.cluster);
  put(fit.status);
}

std::size_t PlaneIndex(const std::vector<MapPlane>& planes, MapPart part, const std::string& name) {
  std::size_t at = 0;
  while (at < planes.size() && (planes[at].part != part || planes[at].name != name)) ++at;
  return at;
}

}  // namespace lobefit
