// made_of.cpp  see made_of.hpp.
#include "baker/trade/source/made_of.hpp"

#include <filesystem>

#include "baker/trade/source/fingerprint.hpp"
#include "baker/trade/source/processor.hpp"
#include "sinew/isa.hpp"

namespace sinew::baker {
namespace {

std::string of_program() {
  constexpr const char* kItself = "/proc/self/exe";
  return std::filesystem::exists(kItself) ? Fingerprint().add_file(kItself).text() : "unknown";
}

std::string of_motions(std::span<const TrueSurface> surfaces) {
  Fingerprint of;
  for (const TrueSurface& surface : surfaces)
    of.add(surface.name()).add(std::to_string(surface.fingerprint()));
  return of.text();
}

std::string of_source(const BakedFrom& source) {
  Fingerprint of;
  of.add_file(source.glb).add_file(source.recipe).add_file(source.rods).add_file(source.emulator);
  for (const std::string& weights : source.weights) of.add_file(weights);
  return of.text();
}

}  // namespace

nlohmann::ordered_json made_of(const LoadedPack& character, std::span<const TrueSurface> surfaces,
                               const BakedFrom& source) {
  return {{"program", of_program()},         {"processor", processor_name()},
          {"instruction set", active_isa()}, {"character", Fingerprint().add(character.bytes()).text()},
          {"motions", of_motions(surfaces)}, {"source, recipe or weights", of_source(source)}};
}

}  // namespace sinew::baker
