// judge.cpp  Characters judged against ground truth in closed loop.
#include <nlohmann/json.hpp>

#include "baker/common/files/safetensors.hpp"
#include "tests/baker/programs/creature_hop.hpp"

using namespace sinew;
using namespace sinew::baker;
using namespace sinew::test;

namespace {

// 50 ticks, and the creature with the shipped weights and without.
class Hop : public CreatureHop {
 public:
  Hop()
      : CreatureHop({.name = "hop_of_judge", .source = __FILE__, .seconds = "0.834", .more = bake_others}) {}
  std::string pack(const std::string& name) const { return pack_of(*this, name); }

 private:
  static std::string pack_of(const CreatureHop& hop, const std::string& name) {
    return hop.folder.file(name + ".sinew");
  }
  static void bake_others(const CreatureHop& hop) {
    character(hop, "network", {"--tissue", hop.weights});
    character(hop, "modes", {});
  }
  static void character(const CreatureHop& hop, const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"character", hop.glb, "--recipe",
                                          hop.recipe,  "-o",    pack_of(hop, name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    must(bake(arguments));
  }
};

const Hop& hop() {
  static const Hop made;
  return made;
}

nlohmann::json judged(std::vector<std::string> arguments, int exit_code = 0) {
  arguments.insert(arguments.begin(), "judge");
  arguments.push_back("--json");
  const ProgramResult result = bake(arguments);
  INFO(result.out << result.error);
  REQUIRE(result.exit_code == exit_code);
  return nlohmann::json::parse(result.out);
}

// The truth with one tensor changed by `change`, under another name.
template <class Change>
std::string changed_truth(const std::string& tensor, const Change& change) {
  Safetensors file = read_safetensors(hop().truth);
  std::vector<float> values = file.tensors.at(tensor).as_f32();
  change(values);
  file.tensors[tensor] = tensor_f32(file.tensors.at(tensor).shape, values);
  const std::string path = hop().folder.file("changed.safetensors");
  write_safetensors(path, file);
  return path;
}

}  // namespace

TEST_CASE("truth_that_is_not_this_character_s_is_refused") {
  const auto refused = [](const std::string& truth, const std::vector<std::string>& words) {
    check_refused({"judge", hop().pack("network"), "--truth", truth}, words);
  };
  refused(kAssets + "weights/creature.safetensors", {"is not a trajectory", "sinew-bake truth"});
  Safetensors old = read_safetensors(hop().truth);
  const std::string path = hop().folder.file("old.safetensors");
  old.metadata["sinew.trajectory"] = "2";
  write_safetensors(path, old);
  refused(path, {"another version"});
  old = read_safetensors(hop().truth);
  old.metadata["rate_hz"] = "30";
  write_safetensors(path, old);
  refused(path, {"30", "--rate"});
  old = read_safetensors(hop().truth);
  old.tensors.erase("joints");
  write_safetensors(path, old);
  refused(path, {"'joints'"});
  refused(changed_truth("node.rest_position", [](auto& v) { v[7] += 0.01f; }),
          {"control node 2 is not where", "it was baked from"});
  refused(changed_truth("displacement", [](auto& v) { v[9] = NAN; }), {"'displacement' is not finite"});
  refused(changed_truth("displacement", [](auto& v) { std::ranges::fill(v, 0.0f); }), {"nothing moves"});
  refused(changed_truth("root", [](auto&) {}), {"'root'", "doubles"});
  const std::string model = hop().folder.file("m.sinew");
  must(bake({"model", kAssets + "weights/creature.safetensors", "-o", model}));
  check_refused({"judge", model, "--truth", hop().truth}, {model, "without a character"});
  check_refused({"judge", hop().pack("network"), "--truth", hop().truth, "--ticks", "600"}, {"shorter"});
}

// The evaluation page has 0.09 of skinning's error left on whole hops; any pose, frame or state out of step
// with the truth leaves several times as much, and a truth of the other sign all of it and more.
TEST_CASE("the_closed_loop_follows_the_truth_and_the_error_is_counted_against_it") {
  const auto ratio_of = [](const nlohmann::json& report) {
    return report["characters"][0]["ticks"]["50"]["ratio"].get<double>();
  };
  const nlohmann::json right = judged({hop().pack("network"), "--truth", hop().truth, "--ticks", "50"});
  INFO(right.dump());
  CHECK(ratio_of(right) < 0.15);
  CHECK(ratio_of(right) > 0.01);
  const std::string negated = changed_truth("displacement", [](auto& v) {
    for (float& value : v) value = -value;
  });
  const nlohmann::json wrong = judged({hop().pack("network"), "--truth", negated, "--ticks", "50"});
  CHECK(ratio_of(wrong) > 1.8);
  CHECK(ratio_of(wrong) < 2.2);
  // Twice the same motion is the same mean.
  const nlohmann::json twice =
      judged({hop().pack("network"), "--truth", hop().truth, hop().truth, "--ticks", "50"});
  CHECK(ratio_of(twice) == Approx(ratio_of(right)).epsilon(1e-12));
}

// The trace is what was judged: its errors are the report's, but that the report holds the truth within the
// limit of what is shown, where this hop gets near it.
TEST_CASE("a_trace_holds_the_displacement_that_is_judged") {
  check_refused(
      {"judge", hop().pack("modes"), "--truth", hop().truth, hop().truth, "--trace", "t.safetensors"},
      {"--trace", "one --truth"});
  constexpr double kHeld = 0.05;
  const std::string path = hop().folder.file("trace.safetensors");
  const nlohmann::json said = judged(
      {hop().pack("modes"), hop().pack("network"), "--truth", hop().truth, "--ticks", "50", "--trace", path});
  const Safetensors trace = read_safetensors(path), truth = read_safetensors(hop().truth);
  const Tensor& true_tensor = truth.tensors.at("displacement");
  const long nodes = static_cast<long>(true_tensor.shape[1]);
  const std::vector<float> u = trace.need("displacement.1", {51, nodes, 3}).as_f32(),
                           wanted = true_tensor.as_f32();
  std::vector<double> errors;
  double sum = 0;
  for (size_t i = 3 * static_cast<size_t>(nodes); i < u.size(); i += 3) {
    errors.push_back(1e3 * std::hypot(double{u[i]} - double{wanted[i]},
                                      double{u[i + 1]} - double{wanted[i + 1]},
                                      double{u[i + 2]} - double{wanted[i + 2]}));
    sum += errors.back();
  }
  std::ranges::sort(errors);
  const nlohmann::json& at = said["characters"][1]["ticks"]["50"];
  CHECK(at["mean_mm"].get<double>() == Approx(sum / static_cast<double>(errors.size())).epsilon(kHeld));
  CHECK(at["p95_mm"].get<double>() ==
        Approx(errors[static_cast<size_t>(0.95 * static_cast<double>(errors.size() - 1))]).epsilon(kHeld));
  // A body that swings errs by more of what changes in a tick than of where it is.
  CHECK(at["velocity_ratio"].get<double>() > at["ratio"].get<double>());
  CHECK(at["velocity_ratio"].get<double>() < 0.5);
}

TEST_CASE("a_character_adds_nothing_to_itself_and_a_worse_one_fails_the_check") {
  const nlohmann::json same =
      judged({hop().pack("network"), hop().pack("network"), "--truth", hop().truth, "--most-added", "0"});
  CHECK(same["characters"][1]["ticks"]["50"]["added"] == 0);
  CHECK(same["characters"][1]["ticks"]["50"]["apart"] == 0);
  const nlohmann::json modes =
      judged({hop().pack("network"), hop().pack("modes"), "--truth", hop().truth, "--most-added", "0"}, 1);
  CHECK(modes["characters"][1]["ticks"]["50"]["added"].get<double>() > 0);
  CHECK(modes["ok"] == false);
}

// An output that overshoots wildly: the budget keeps it from harm, but not from being wrong.
TEST_CASE("a_network_that_overshoots_a_thousandfold_is_left_out_of_the_pack") {
  Safetensors wild = read_safetensors(kAssets + "weights/creature.safetensors");
  wild.metadata["output_scale"] = "1000";
  const std::string path = hop().folder.file("wild.safetensors"), out = hop().folder.file("wild.sinew");
  write_safetensors(path, wild);
  const ProgramResult result =
      bake({"character", hop().glb, "--recipe", hop().recipe, "--tissue", path, "-o", out});
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("the network is left out: on this character"));
}
