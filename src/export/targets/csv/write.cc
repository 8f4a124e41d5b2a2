#include "lobefit/export/targets/csv/write.h"

#include "lobefit/export/targets/features.h"
#include "lobefit/io/csv/writer.h"
#include "lobefit/io/read.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/interpolation.h"
#include "lobefit/synthesis/synthesis.h"

namespace lobefit {
namespace {

WrittenFiles WriteCsvSamples(const FittedBrdf& fit, const WriteContext& context) {
  const std::filesystem::path path = context.File(".csv");
  GoniometerLayout layout;
  for (int theta = 0; theta <= 80; theta += 10) layout.polar_angles.push_back(DegreesToRadians(theta));
  const int azimuths = fit.IsIsotropic() ? 1 : 12;
  for (int a = 0; a < azimuths; ++a) layout.azimuths.push_back(2 * kPi * a / azimuths);
  layout.detector_step = DegreesToRadians(6);
  const Measurement samples = Synthesise(Goniometer(layout), fit.channels(), fit.function(), {}, 0);
  RequireReadableChannels(samples.channels);
  WriteCsv(samples, context.header, path);
  Measurement back = ReadMeasurement(path);
  back.isotropic = fit.IsIsotropic();
  return {{path}, Interpolate(back), false, {"samples; the error is that of interpolation between them"}};
}

}  // namespace

Target CsvTarget() {
  return {.name = "csv",
          .description = "samples over a goniometer's directions",
          .load = "lobefit info {name}.csv",
          .carries = CarriesTable,
          .write = WriteCsvSamples};
}

}  // namespace lobefit
