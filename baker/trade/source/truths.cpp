// truths.cpp  see truths.hpp.
#include "baker/trade/source/truths.hpp"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "baker/common/on_all_cores.hpp"
#include "baker/measure/true_motion.hpp"
#include "baker/mesh/recipe/import_character.hpp"
#include "baker/trade/source/fingerprint.hpp"
#include "baker/truth/trajectory.hpp"
#include "baker/truth/voxel_nodes.hpp"

namespace sinew::baker {
namespace {

constexpr uint64_t kOtherSeed = 7001;  // no plan of the trainer reaches it

struct Work {
  const Clip* clip;
  uint64_t seed;
  std::string path;
};

struct Body {
  const Character& character;
  const TissueLayout& layout;
  const Recipe& recipe;
  double rate_hz;
  size_t ticks;
};

std::vector<const Clip*> chosen(const Character& character, const std::vector<std::string>& names,
                                const std::string& glb) {
  std::vector<const Clip*> out;
  for (const Clip& clip : character.clips)
    if (names.empty()) out.push_back(&clip);
  for (const std::string& name : names) {
    const auto found = std::ranges::find(character.clips, name, &Clip::name);
    if (found == character.clips.end())
      throw BadInput("--clip " + name + ": " + glb + " has no such clip; sinew-bake info shows those it has");
    if (std::ranges::find(out, &*found) == out.end()) out.push_back(&*found);
  }
  if (out.empty()) throw BadInput(glb + ": has no clips; give trajectories by --truth");
  return out;
}

// Channels and mesh too: a .gltf has them in other files. Frequencies go by all clips
// (mesh/regions/clip_frequency.hpp).
std::string made_from(const BakedFrom& source, const Character& body, const TissueLayout& layout,
                      const Clip& clip, double rate_hz) {
  Fingerprint of;
  of.add_file(source.glb).add_file(source.recipe).add(clip.name);
  of.add_all(body.positions).add_all(body.skin).add_all(body.stiffness);
  for (const Channel& channel : clip.channels) of.add_all(channel.times_s).add_all(channel.values);
  for (const Region& region : layout.regions) of.add(std::to_string(region.frequency_hz));
  for (const ControlNode& node : layout.nodes) of.add(std::to_string(node.vertex));
  return of.add(std::to_string(rate_hz) + " " + kTrajectoryVersion).text();
}

std::string as_file_name(std::string clip) {
  constexpr size_t kMostLetters = 60;
  for (char& c : clip)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return clip.substr(0, kMostLetters);
}

std::string in_seconds(double seconds) {
  char text[24];
  std::snprintf(text, sizeof text, "%gs", seconds);
  return text;
}

// Whatever a truth depends on is in its file's name.
std::vector<Work> work_of(const BakedFrom& source, const Character& body, const TissueLayout& layout,
                          const std::vector<const Clip*>& clips, double seconds, double rate_hz,
                          const std::string& folder) {
  std::vector<Work> out;
  for (const uint64_t seed : {uint64_t{0}, kOtherSeed})
    for (const Clip* clip : clips)
      out.push_back({clip, seed,
                     folder + "/" + as_file_name(clip->name) + "_" + std::to_string(seed) + "_" +
                         in_seconds(seconds) + "_" + made_from(source, body, layout, *clip, rate_hz) +
                         ".safetensors"});
  return out;
}

void tell_of_others(const std::vector<Work>& wanted, const std::vector<std::string>& paths,
                    const std::string& folder) {
  if (!std::filesystem::is_directory(folder)) return;
  for (const auto& held : std::filesystem::directory_iterator(folder)) {
    if (std::ranges::find(paths, held.path().string()) != paths.end()) continue;
    std::fprintf(stderr,
                 "sinew-trade: %s: what it holds is of other clips, seconds, sources or recipes; %zu motions "
                 "are simulated again\n",
                 folder.c_str(), wanted.size());
    return;
  }
}

void simulate(const Body& body, const Work& work, std::atomic<size_t>& done) {
  TissueTruth truth(body.character, body.layout, body.recipe);
  const std::vector<ModalBasis> modes = truth.modal_bases(body.layout, kMostModes);
  const int substeps = usual_substeps(modes, body.rate_hz);
  TrajectoryRecorder recorder(body.character, body.layout,
                              {.rate_hz = body.rate_hz, .surface = false, .positions = true}, modes);
  recorder.add(truth.start(clip_motion(body.character, *work.clip, work.seed)));
  for (size_t tick = 1; tick <= body.ticks; ++tick) {
    recorder.add(truth.advance(body.rate_hz, substeps));
    ++done;
  }
  const auto rate = static_cast<long>(std::lround(body.rate_hz));
  write_safetensors(work.path, recorder.finish({{"motion", "clip:" + work.clip->name},
                                                {"seed", std::to_string(work.seed)},
                                                {"strength", "1"},
                                                {"rate_hz", std::to_string(rate)}}));
}

void simulate_all(const Body& body, const std::vector<Work>& work) {
  on_all_cores("ground truth", work.size() * body.ticks, work.size(),
               [&](size_t piece, std::atomic<size_t>& done) { simulate(body, work[piece], done); });
}

}  // namespace

Character BakedFrom::import(const Recipe& as) const { return import_character(glb, as); }

std::vector<std::string> simulate_clips(const BakedFrom& source, const std::vector<std::string>& clips,
                                        double seconds, const pack::PackView& character,
                                        const std::string& folder) {
  const Recipe recipe = source.read();
  Character body = source.import(recipe);
  const TissueLayout layout = layout_to_bake(body, recipe);
  if (layout.nodes.size() != character.nodes.size() ||
      body.positions.size() != character.character->vertex_count)
    throw BadInput(source.glb +
                   ": with this recipe it is another character than the pack; give what it was baked from");
  const double rate_hz = static_cast<double>(character.network->rate_hz);
  std::vector<Work> wanted =
      work_of(source, body, layout, chosen(body, clips, source.glb), seconds, rate_hz, folder);
  std::vector<std::string> paths;
  for (const Work& work : wanted) paths.push_back(work.path);
  std::erase_if(wanted, [](const Work& work) { return std::filesystem::exists(work.path); });
  if (wanted.empty()) return paths;
  tell_of_others(wanted, paths, folder);
  make_folder(folder);
  simulate_all({body, layout, recipe, rate_hz, static_cast<size_t>(std::lround(seconds * rate_hz))}, wanted);
  return paths;
}

}  // namespace sinew::baker
