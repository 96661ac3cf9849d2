// bake_info.cpp  sinew-bake info: what is inside a baked file, a weights file or a character to bake.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "baker/import/import_gltf.hpp"
#include "baker/programs/commands.hpp"
#include "baker/programs/describe/describe.hpp"
#include "baker/programs/describe/describe_source.hpp"

namespace sinew::baker {
namespace {

struct InfoOptions {
  std::string file;
  bool json = false;
};

using Json = nlohmann::ordered_json;

bool is_source(const std::string& path) {
  std::string kind = std::filesystem::path(path).extension();
  std::ranges::transform(kind, kind.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind == ".glb" || kind == ".gltf" || kind == ".vrm";
}

Json describe(const std::string& path) {
  if (looks_like_pack(path)) return describe_pack(LoadedPack::from_file(path));
  if (is_source(path)) {
    Json description = describe_source(import_gltf(path));
    description["bytes"] = std::filesystem::file_size(path);
    return description;
  }
  return describe_safetensors(read_safetensors(path));
}

void run_info(const InfoOptions& options) {
  const Json description = describe(options.file);
  const std::string text = options.json
                               ? description.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"
                               : options.file + ": " + format_description(description);
  std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_info_command(CLI::App& app, int*) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand(
      "info", "Shows what is inside a file; of a glTF or VRM the bones and meshes that a recipe names");
  command->add_option("file", options->file, ".sinew, .safetensors, .glb, .gltf or .vrm")->required();
  command->add_flag("--json", options->json, "one line of JSON");
  command->callback([options] { run_info(*options); });
}

}  // namespace sinew::baker
