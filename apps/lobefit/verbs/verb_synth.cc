// lobefit synth: a measurement file from a known model, with declared noise.
#include <filesystem>
#include <memory>

#include "options/synthesis_options.h"
#include "tasks/stack_synthesis.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/io/csv/writer.h"
#include "lobefit/io/write.h"
#include "lobefit/measurement/spectrum.h"
#include "lobefit/validate/truth_file.h"

namespace lobefit {
namespace {

struct SynthVerb {
  SynthesisOptions synthesis;
  std::string source, out;
  int digits = 17;
  StackSynthesisOptions stack;
};

int RunSynth(const SynthVerb& verb, const CommonOptions& common) {
  if (verb.stack.wanted()) return verb.stack.Write(verb.source, verb.synthesis, verb.out);
  CheckOutput(verb.out, {verb.source, verb.synthesis.Layout().name});
  const WriteFormat& format = FindWriteFormat(std::nullopt, verb.out == "-" ? "-.csv" : verb.out);
  const Truth truth = verb.synthesis.LoadTruth(verb.source);
  const Noise noise = verb.synthesis.ChosenNoise();
  const MeasurementLayout layout = MakeLayout(verb.synthesis.Layout(), truth);
  RequireApertureWithin(layout, noise);
  const BrdfFunction brdf = BrdfOf(truth);
  Measurement measurement = Synthesise(layout.directions, ChannelsNamed(truth.channels), brdf, noise,
                                       verb.synthesis.seed(), SmallestAlpha(truth));
  measurement.isotropic = layout.isotropic;
  measurement.source = "synthetic";
  const TruthRecord record = {truth, noise, verb.synthesis.seed(), common.command};
  if (std::string(format.name) == "csv") {
    WriteCsv(measurement, TruthComments(record), verb.out, verb.digits);
  } else {
    WriteSource source = {&measurement, nullptr, measurement.channels, measurement.isotropic};
    // A grid asks for f_r at directions of its own: without random terms the model answers, else the samples nearby.
    if (format.is_grid && noise == Noise{}) source.brdf = brdf;
    format.write(source, {}, verb.out);
    WriteTruthBeside(record, verb.out);
  }
  Print(fmt::format("{}: {} samples, {} channels\n", PrintableName(verb.out), measurement.samples.size(),
                    measurement.channels.size()),
        SummaryStream(verb.out));
  return kExitDone;
}

}  // namespace

std::function<int()> SetUpSynth(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<SynthVerb>();
  app->add_option("SOURCE", verb->source,
                  "a *.material.json, or a recipe (.toml or name) whose parameters have starts or fixed values; with "
                  "--stack, a *.maps.exr, or hills or brushed-hills, which are made up")
      ->required();
  app->add_option("--out", verb->out,
                  "the file to write; its ending names the format (.csv, .alta, .txt, .binary, .bsdf, ...); - writes "
                  "CSV to standard output")
      ->required();
  app->add_option("--digits", verb->digits, "significant digits of the numbers (default 17: nothing is lost)")
      ->check(CLI::Range(4, 17));
  verb->synthesis.AddTo(app);
  verb->stack.AddTo(app);
  return [=] { return RunSynth(*verb, *common); };
}

}  // namespace lobefit
