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
  check_precision(options.precision);
  PackWriter writer(pack::FileKind::kModel);
  add_network(read_safetensors(options.weights), writer);
  const std::vector<std::byte> bytes = writer.finish();
  LoadedPack::from_bytes(bytes, options.weights);  // what the runtime would refuse is not written
  write_file(options.output, bytes);
}

}  // namespace

void check_precision(const std::string& precision) {
  if (precision != "fp32")
    throw BadInput("--precision " + precision + ": not built in this version; use fp32");
}

void add_model_command(CLI::App& app, int*) {
  auto options = std::make_shared<ModelOptions>();
  CLI::App* command = app.add_subcommand("model", "Packs trained weights");
  command->add_option("weights", options->weights, "safetensors")->required();
  command->add_option("--precision", options->precision, "fp32");
  command->add_option("-o,--output", options->output, "M.sinew")->required();
  command->callback([options] { run_model(*options); });
}

}  // namespace sinew::baker
