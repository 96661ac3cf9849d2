// clips.cpp  Animation channels, checked (glTF 2.0, 3.11).
#include "baker/import/skeleton/clips.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

constexpr const char* kMend = "the file is damaged; export it again";
constexpr size_t kMaxNumbers =
    100'000'000;  // keys of all clips together; many channels may share one accessor

class ClipReader {
 public:
  ClipReader(const tinygltf::Model& model, const SceneGraph& graph, const AccessorReader& accessors,
             Source& source)
      : model_(model), graph_(graph), accessors_(accessors), source_(source) {}

  Clip read(size_t index) {
    const tinygltf::Animation& file = model_.animations[index];
    Clip clip;
    clip.name = file.name.empty() ? "animation_" + std::to_string(index) : file.name;
    size_t morphs = 0;
    for (size_t c = 0; c < file.channels.size(); ++c) {
      const std::string where =
          "animation " + std::to_string(index) + " '" + clip.name + "' channel " + std::to_string(c);
      if (file.channels[c].target_path == "weights")
        ++morphs;
      else
        read_channel(file, file.channels[c], where, clip);
    }
    if (morphs > 0)
      source_.note("animation '" + clip.name + "'",
                   std::to_string(morphs) + " channels of morph weights: ignored");
    return clip;
  }

 private:
  void read_channel(const tinygltf::Animation& file, const tinygltf::AnimationChannel& from,
                    const std::string& where, Clip& clip) {
    if (from.sampler < 0 || static_cast<size_t>(from.sampler) >= file.samplers.size())
      source_.refuse(where,
                     "names sampler " + std::to_string(from.sampler) + ", the animation has " +
                         std::to_string(file.samplers.size()),
                     kMend);
    if (from.target_node == -1) return;  // aimed by an extension at something that is not a node
    if (from.target_node < 0 || static_cast<size_t>(from.target_node) >= graph_.nodes.size())
      source_.refuse(where,
                     "names node " + std::to_string(from.target_node) + ", the file has " +
                         std::to_string(graph_.nodes.size()),
                     kMend);
    Channel channel;
    channel.node = graph_.node_of_file[static_cast<size_t>(from.target_node)];
    const tinygltf::AnimationSampler& sampler = file.samplers[static_cast<size_t>(from.sampler)];
    if (!read_kind(from, sampler, where, channel) || !read_keys(sampler, where, channel)) return;
    clip.duration_s = std::max(clip.duration_s, channel.times_s.back());
    clip.channels.push_back(std::move(channel));
  }

  bool read_kind(const tinygltf::AnimationChannel& from, const tinygltf::AnimationSampler& sampler,
                 const std::string& where, Channel& channel) {
    if (from.target_path == "translation")
      channel.path = Path::kTranslation;
    else if (from.target_path == "rotation")
      channel.path = Path::kRotation;
    else if (from.target_path == "scale")
      channel.path = Path::kScale;
    else
      return source_.note(where, "animates '" + from.target_path + "': left out"), false;
    if (sampler.interpolation == "STEP")
      channel.interpolation = Interpolation::kStep;
    else if (sampler.interpolation == "CUBICSPLINE")
      channel.interpolation = Interpolation::kCubicSpline;
    else if (sampler.interpolation != "LINEAR" && !sampler.interpolation.empty())
      source_.note(where, "unknown interpolation '" + sampler.interpolation + "': linear");
    if (graph_.nodes[static_cast<size_t>(channel.node)].has_matrix)
      return source_.note(where, "its node is a matrix, which glTF does not animate: left out"), false;
    return true;
  }

  bool read_keys(const tinygltf::AnimationSampler& sampler, const std::string& where, Channel& channel) {
    const int width = channel.path == Path::kRotation ? 4 : 3;
    const size_t values_a_key =
        static_cast<size_t>(channel.interpolation == Interpolation::kCubicSpline ? 3 * width : width);
    numbers_ += accessors_.count(sampler.input, where + " input") * (1 + values_a_key);
    if (numbers_ > kMaxNumbers)
      source_.refuse(where, "the animations hold more than " + std::to_string(kMaxNumbers) + " numbers",
                     "export fewer or shorter clips");
    channel.times_s = accessors_.numbers(sampler.input, 1, where + " input");
    if (accessors_.count(sampler.output, where + " output") * static_cast<size_t>(width) !=
        channel.times_s.size() * values_a_key)
      return source_.note(where, "has " + std::to_string(channel.times_s.size()) + " times but " +
                                     std::to_string(accessors_.count(sampler.output, where)) +
                                     " values: left out"),
             false;
    channel.values = accessors_.numbers(sampler.output, width, where + " output");
    return check_keys(where, channel);
  }

  bool check_keys(const std::string& where, const Channel& channel) {
    if (channel.times_s.empty()) return source_.note(where, "has no keys: left out"), false;
    const auto finite = [](double value) { return std::isfinite(value); };
    if (!std::all_of(channel.times_s.begin(), channel.times_s.end(), finite) ||
        !std::all_of(channel.values.begin(), channel.values.end(), finite))
      return source_.note(where, "has keys that are NaN or infinite: left out"), false;
    const auto not_later = [](double a, double b) { return b <= a; };
    if (channel.times_s.front() < 0 || std::adjacent_find(channel.times_s.begin(), channel.times_s.end(),
                                                          not_later) != channel.times_s.end())
      return source_.note(where, "its times do not ascend from zero: left out"), false;
    return true;
  }

  const tinygltf::Model& model_;
  const SceneGraph& graph_;
  const AccessorReader& accessors_;
  Source& source_;
  size_t numbers_ = 0;
};

}  // namespace

std::vector<Clip> read_clips(const tinygltf::Model& model, const SceneGraph& graph,
                             const AccessorReader& accessors, Source& source) {
  ClipReader reader(model, graph, accessors, source);
  std::vector<Clip> clips;
  for (size_t i = 0; i < model.animations.size(); ++i) {
    Clip clip = reader.read(i);
    if (clip.channels.empty())
      source.note("animation '" + clip.name + "'", "moves no node: left out");
    else
      clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace sinew::baker
