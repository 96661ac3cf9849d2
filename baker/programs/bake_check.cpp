// bake_check.cpp  sinew-bake check: a network against reference vectors.
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/measure/network/roll_out.hpp"
#include "baker/programs/commands.hpp"
#include "kernels/isa.hpp"

namespace sinew::baker {
namespace {

// Of each precision: in float32 the contract; else twice what the reference vectors of Alt-ConvLSTM show, on
// outputs and states over fifty steps of the paper's wiring, where nothing leaks and sums grow to tens.
constexpr double kTolerances[] = {1e-5, 0.06, 0.12};

struct CheckOptions {
  std::string model, vectors, isa, precision;
  std::optional<double> tolerance;
};

const char* precision_of(const LoadedPack& model) {
  return pack::kPrecisionNames[static_cast<uint32_t>(model.view().network->precision)];
}

const char* model_name(const LoadedPack& model) {
  return pack::kModelNames[static_cast<uint32_t>(model.view().network->model)];
}

// A pack runs in the precision it was baked in, weights in the one asked for, int8 calibrated on the vectors.
LoadedPack load_model(const CheckOptions& options) {
  const std::string& wanted = options.precision;
  if (!looks_like_pack(options.model))
    return LoadedPack::from_weights(options.model, parse_precision(wanted.empty() ? "fp32" : wanted),
                                    options.vectors);
  LoadedPack model = LoadedPack::from_file(options.model);
  if (!wanted.empty() && wanted != precision_of(model))
    throw BadInput(options.model + ": was baked with --precision " + precision_of(model) + ", not " + wanted +
                   "; check it as it is, or check its weights");
  return model;
}

RollOutError error_of(const LoadedPack& model, const std::string& path, const Safetensors& vectors) {
  switch (model.view().network->model) {
    case pack::ModelKind::kNone:
      throw BadInput(path + ": holds no network, so there is nothing to check; bake it with --tissue");
    case pack::ModelKind::kDeepEmulator:
      return roll_out_deep_emulator(model.deep_emulator(), model.view().network->moving != 0, vectors);
    case pack::ModelKind::kCopingNet:
      return evaluate_coping_net(model.coping_net(), vectors);
    case pack::ModelKind::kAltConvLstm:
      break;
  }
  if (model.is_reduced()) return roll_out(model.reduced_network(), vectors);
  return roll_out(model.network(), vectors);
}

int run_check(const CheckOptions& options) {
  if (!options.precision.empty()) parse_precision(options.precision);
  if (!(options.tolerance.value_or(0) >= 0)) throw BadInput("--tolerance: must be a number from 0 up");
  choose_isa(options.isa);
  const LoadedPack model = load_model(options);
  const RollOutError error = error_of(model, options.model, read_safetensors(options.vectors));
  const double tolerance =
      options.tolerance.value_or(kTolerances[static_cast<uint32_t>(model.view().network->precision)]);
  const bool ok = error.max_abs_error <= tolerance;
  const nlohmann::ordered_json report = {{"model", model_name(model)},
                                         {"isa", simd::active_isa()},
                                         {"precision", precision_of(model)},
                                         {"steps", error.steps},
                                         {"max_abs_error", error.max_abs_error},
                                         {"mean_abs_error", error.mean_abs_error},
                                         {"tolerance", tolerance},
                                         {"ok", ok}};
  std::printf("%s\n", report.dump().c_str());
  return ok ? 0 : 1;
}

}  // namespace

void choose_isa(const std::string& name) {
  const Status status = name.empty() ? simd::check_environment() : simd::force_isa(name.c_str());
  if (!status.ok()) throw BadInput((name.empty() ? "" : "--isa " + name + ": ") + status.message);
}

void add_check_command(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check",
                                         "Runs a network on reference vectors, what it puts out fed back "
                                         "where it has steps; exit 1 beyond the tolerance");
  command->add_option("model", options->model, ".sinew or weights as .safetensors")->required();
  command->add_option("vectors", options->vectors, "reference vectors as .safetensors")->required();
  command->add_option("--precision", options->precision,
                      "fp32, fp16 or int8; by default what the pack was baked in, of weights fp32");
  command->add_option("--isa", options->isa, "an instruction set of this processor; the best by default");
  command->add_option("--tolerance", options->tolerance,
                      "largest absolute error; by default 1e-5 (fp32), 0.06 (fp16), 0.12 (int8)");
  command->callback([options, exit_code] { *exit_code = run_check(*options); });
}

}  // namespace sinew::baker
