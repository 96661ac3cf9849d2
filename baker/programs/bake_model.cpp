// bake_model.cpp  sinew-bake model: trained weights to a pack of the network alone.
#include <memory>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/programs/commands.hpp"

namespace sinew::baker {
namespace {

struct ModelOptions {
  std::string weights, output, calibration, precision = "fp32";
};

void run_model(const ModelOptions& options) {
  const pack::Precision precision = parse_precision(options.precision);
  check_calibration(precision, !options.calibration.empty());
  const LoadedPack packed = LoadedPack::from_weights(options.weights, precision, options.calibration);
  write_file(options.output, packed.bytes());
}

}  // namespace

pack::Precision parse_precision(const std::string& name) {
  std::string known;
  for (uint32_t k = 0; k < std::size(pack::kPrecisionNames); ++k) {
    if (name == pack::kPrecisionNames[k]) return static_cast<pack::Precision>(k);
    known += std::string(k == 0 ? "" : ", ") + pack::kPrecisionNames[k];
  }
  throw BadInput("--precision " + name + ": not built in this version; use one of " + known);
}

void check_calibration(pack::Precision precision, bool given) {
  if (given && precision != pack::Precision::kInt8)
    throw BadInput("--calibrate: only --precision int8 takes its scales from vectors; leave it out");
}

void add_precision_option(CLI::App* command, std::string* precision) {
  command->add_option(
      "--precision", *precision,
      "fp32; fp16: states of hidden layers stored as halves; int8: and their products of bytes");
}

void add_model_command(CLI::App& app, int*) {
  auto options = std::make_shared<ModelOptions>();
  CLI::App* command = app.add_subcommand("model", "Packs trained weights");
  command->add_option("weights", options->weights, "safetensors")->required();
  add_precision_option(command, &options->precision);
  command->add_option(
      "--calibrate", options->calibration,
      "reference vectors that int8 takes its scales from; by default those next to the weights, "
      "else a made-up motion");
  add_output(*command, "-o,--output", options->output, "M.sinew")->required();
  command->callback([options] { run_model(*options); });
}

}  // namespace sinew::baker
