// bake_model.cpp  sinew-bake model: trained weights to a pack of the network alone.
#include <memory>

#include "baker/common/bad_input.hpp"
#include "baker/common/write_file.hpp"
#include "baker/pack/network_pack.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/loaded_pack.hpp"

namespace sinew::baker {
namespace {

struct ModelOptions {
  std::string weights, output, precision = "fp32";
};

void run_model(const ModelOptions& options) {
  const pack::Precision precision = parse_precision(options.precision);
  PackWriter writer(pack::FileKind::kModel);
  add_network(read_safetensors(options.weights), writer, precision);
  const std::vector<std::byte> bytes = writer.finish();
  LoadedPack::from_bytes(bytes, options.weights);  // what the runtime would refuse is not written
  write_file(options.output, bytes);
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

void add_model_command(CLI::App& app, int*) {
  auto options = std::make_shared<ModelOptions>();
  CLI::App* command = app.add_subcommand("model", "Packs trained weights");
  command->add_option("weights", options->weights, "safetensors")->required();
  command->add_option("--precision", options->precision,
                      "fp32, or fp16: states of hidden layers kept as halves");
  command->add_option("-o,--output", options->output, "M.sinew")->required();
  command->callback([options] { run_model(*options); });
}

}  // namespace sinew::baker
