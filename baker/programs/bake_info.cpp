// bake_info.cpp  sinew-bake info: what is inside a baked file or a weights file.
#include <cstdio>
#include <memory>

#include "baker/programs/commands.hpp"
#include "baker/programs/describe.hpp"

namespace sinew::baker {
namespace {

struct InfoOptions {
  std::string file;
  bool json = false;
};

void run_info(const InfoOptions& options) {
  using Json = nlohmann::ordered_json;
  const Json description = looks_like_pack(options.file)
                               ? describe_pack(LoadedPack::from_file(options.file))
                               : describe_safetensors(read_safetensors(options.file));
  const std::string text = options.json
                               ? description.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"
                               : options.file + ": " + format_description(description);
  std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_info_command(CLI::App& app, int*) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Shows what is inside a .sinew or .safetensors file");
  command->add_option("file", options->file, ".sinew or .safetensors")->required();
  command->add_flag("--json", options->json, "one line of JSON");
  command->callback([options] { run_info(*options); });
}

}  // namespace sinew::baker
