// read_creature_recipe.cpp  The JSON of a creature, with its mirrored halves written out.
#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/json_section.hpp"
#include "baker/creature/clip.hpp"
#include "baker/creature/creature.hpp"
#include "baker/creature/skin.hpp"

namespace sinew::baker {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest_m = 10;

// "ear_l_1" -> "ear_r_1", "foot_l" -> "foot_r"; names without a side stay.
std::string mirrored(std::string name) {
  for (size_t i = 0; i + 1 < name.size(); ++i) {
    const bool ends = i + 2 == name.size() || name[i + 2] == '_' || name[i + 2] == '*';
    if (name[i] == '_' && name[i + 1] == 'l' && ends) {
      name[i + 1] = 'r';
      break;
    }
  }
  return name;
}

std::vector<std::string> mirrored(std::vector<std::string> names) {
  for (std::string& name : names) name = mirrored(name);
  return names;
}

Vector3d mirrored(const Vector3d& v) { return {-v.x(), v.y(), v.z()}; }

Solid mirrored(Solid solid) {
  solid.at = mirrored(solid.at);
  solid.flat_axis = mirrored(solid.flat_axis);
  solid.turn_deg = {solid.turn_deg.x(), -solid.turn_deg.y(), -solid.turn_deg.z()};
  for (Eigen::Vector4d& point : solid.points) point.x() = -point.x();
  return solid;
}

Track mirrored(Track track, double later) {  // shares of the clip
  track.joints = mirrored(track.joints);
  const bool negated = track.axis == Axis::kMoveX || track.axis == Axis::kTurnY || track.axis == Axis::kTurnZ;
  const double sign = negated ? -1 : 1;
  for (Eigen::Vector2d& key : track.keys) {
    key.x() += later >= 1 - key.x() ? later - 1 : later;
    key.y() *= sign;
  }
  std::stable_sort(track.keys.begin(), track.keys.end(),
                   [](const auto& a, const auto& b) { return a.x() < b.x(); });
  track.amplitude *= sign;
  track.phase -= later * track.cycles;
  return track;
}

Solid read_solid(JsonSection& json) {
  Solid solid;
  for (const Eigen::VectorXd& row : json.rows("tube", 4, -kFarthest_m, kFarthest_m)) {
    if (row[3] <= 0) json.complain("tube", "holds a radius that is not above 0");
    solid.points.push_back(row);
  }
  if (!solid.points.empty()) {
    if (solid.points.size() < 2) json.complain("tube", "needs two points or more");
    solid.flat = json.number("flat", 1, 0.05, 1);
    solid.flat_axis = json.vector3("flat_axis", solid.flat_axis, -1, 1);
    if (solid.flat_axis.norm() < 1e-6) json.complain("flat_axis", "must not be zero");
    return solid;
  }
  solid.at = json.numbers("at", 3, -kFarthest_m, kFarthest_m);
  solid.radii = json.numbers("radii", 3, 1e-4, kFarthest_m);
  solid.turn_deg = json.vector3("turn_deg", solid.turn_deg, -360, 360);
  return solid;
}

class RecipeReader {
 public:
  explicit RecipeReader(const JsonFile& file) : root_(file) {}

  CreatureRecipe run() {
    recipe_.name = root_.text("name");
    recipe_.vertices =
        static_cast<size_t>(root_.number("vertices", 7000, kFewestCreatureVertices, kMostCreatureVertices));
    recipe_.key_rate_hz = root_.number("key_rate_hz", 30, 1, 240);
    for (JsonSection& json : root_.sections("joints")) read_joint(json);
    if (recipe_.joints.empty()) root_.complain("joints", "must name at least one joint");
    place_tips();
    for (JsonSection& json : root_.sections("limbs")) read_limb(json);
    for (JsonSection& json : root_.sections("body")) read_part(json);
    if (recipe_.body.empty()) root_.complain("body", "must hold at least one part");
    for (JsonSection& json : root_.sections("materials")) read_material(json);
    if (recipe_.materials.empty()) root_.complain("materials", "must hold at least the body's");
    for (JsonSection& json : root_.sections("details")) read_detail(json);
    for (JsonSection& json : root_.sections("coat")) read_layer(json, recipe_.coat, true);
    for (JsonSection& json : root_.sections("tissue")) read_layer(json, recipe_.tissue, false);
    read_skin();
    for (JsonSection& json : root_.sections("stance")) read_track(json, recipe_.stance);
    for (JsonSection& json : root_.sections("clips")) read_clip(json);
    root_.finish();
    return std::move(recipe_);
  }

 private:
  void add_joint(const JsonSection& json, const JointRecipe& joint) {
    if (joint_index(recipe_, joint.name) >= 0) json.complain("name", "\"" + joint.name + "\" is taken");
    if (recipe_.joints.empty() != joint.parent.empty())
      json.complain("parent", "must be left out for the first joint and for no other");
    if (!joint.parent.empty() && joint_index(recipe_, joint.parent) < 0)
      json.complain("parent", "\"" + joint.parent + "\" is not a joint above this one");
    recipe_.joints.push_back(joint);
  }

  void read_joint(JsonSection& json) {
    JointRecipe joint;
    joint.name = json.text("name");
    joint.parent = json.text("parent", "");
    joint.at = json.numbers("at", 3, -kFarthest_m, kFarthest_m);
    joint.tip = json.vector3("tip", Vector3d::Constant(NAN), -kFarthest_m, kFarthest_m);
    const bool both_sides = json.flag("mirror", false);
    json.finish();
    add_joint(json, joint);
    if (both_sides)
      add_joint(json,
                {mirrored(joint.name), mirrored(joint.parent), mirrored(joint.at), mirrored(joint.tip)});
  }

  void place_tips() {  // a bone without a tip reaches to its first child
    for (JointRecipe& joint : recipe_.joints) {
      if (std::isfinite(joint.tip.x())) continue;
      joint.tip = joint.at;
      for (const JointRecipe& child : recipe_.joints)
        if (child.parent == joint.name) {
          joint.tip = child.at;
          break;
        }
    }
  }

  void check_joints(const JsonSection& json, const std::string& key,
                    const std::vector<std::string>& names) const {
    for (const std::string& name : names)
      if (matching_joints(recipe_, {name}).empty())
        json.complain(key, "names \"" + name + "\", which is not a joint");
  }

  std::string known_joint(JsonSection& json, const std::string& key) const {
    const std::string name = json.text(key);
    if (joint_index(recipe_, name) < 0) json.complain(key, "names \"" + name + "\", which is not a joint");
    return name;
  }

  std::vector<std::string> known_joints(JsonSection& json, const std::string& key) const {
    const std::vector<std::string> names = json.texts(key);
    check_joints(json, key, names);
    return names;
  }

  void read_limb(JsonSection& json) {
    LimbRecipe limb{known_joint(json, "upper"), known_joint(json, "lower"), known_joint(json, "end"),
                    Vector3d::UnitZ()};
    limb.bend = json.vector3("bend", limb.bend, -1, 1);
    if (limb.bend.norm() < 1e-6) json.complain("bend", "must not be zero");
    const auto parent_of = [&](const std::string& name) {
      return recipe_.joints[static_cast<size_t>(joint_index(recipe_, name))].parent;
    };
    if (parent_of(limb.end) != limb.lower || parent_of(limb.lower) != limb.upper ||
        parent_of(limb.upper).empty())
      json.complain("end", "must be a child of \"lower\", that of \"upper\", and that of another joint");
    const bool both_sides = json.flag("mirror", false);
    json.finish();
    recipe_.limbs.push_back(limb);
    if (!both_sides) return;
    check_joints(json, "mirror", {mirrored(limb.upper), mirrored(limb.lower), mirrored(limb.end)});
    recipe_.limbs.push_back(
        {mirrored(limb.upper), mirrored(limb.lower), mirrored(limb.end), mirrored(limb.bend)});
  }

  void read_part(JsonSection& json) {
    BodyPart part;
    part.name = json.text("name", "");
    part.solid = read_solid(json);
    part.blend_m = json.number("blend_m", 0.03, 0, 1);
    part.carve = json.flag("carve", false);
    part.edge_scale = json.number("edge_scale", 1, 0.2, 5);
    part.joints = known_joints(json, "joints");
    if (!part.carve && part.joints.empty()) json.complain("joints", "must name at least one joint");
    if (recipe_.body.empty() && part.carve) json.complain("carve", "cannot be true for the first part");
    const bool both_sides = json.flag("mirror", false);
    json.finish();
    recipe_.body.push_back(part);
    if (!both_sides) return;
    part.solid = mirrored(part.solid);
    part.joints = mirrored(part.joints);
    check_joints(json, "mirror", part.joints);
    recipe_.body.push_back(part);
  }

  void read_material(JsonSection& json) {
    MaterialRecipe material;
    material.name = json.text("name");
    material.roughness = json.number("roughness", 0.9, 0, 1);
    if (json.has("emissive")) material.emissive = json.color("emissive");
    json.finish();
    recipe_.materials.push_back(material);
  }

  void read_detail(JsonSection& json) {
    DetailRecipe detail;
    detail.name = json.text("name");
    detail.joint = known_joint(json, "joint");
    detail.material = json.text("material");
    if (std::none_of(recipe_.materials.begin(), recipe_.materials.end(),
                     [&](const MaterialRecipe& m) { return m.name == detail.material; }))
      json.complain("material", "names \"" + detail.material + "\", which is not in \"materials\"");
    detail.solid = read_solid(json);
    detail.snap = json.flag("snap", false);
    detail.share = json.number("share", 0.01, 0, 0.02);
    detail.cap_deg = json.number("cap_deg", 180, 10, 180);
    read_bands(json, detail);
    const bool both_sides = json.flag("mirror", false);
    json.finish();
    recipe_.details.push_back(detail);
    if (!both_sides) return;
    detail.name = mirrored(detail.name);
    detail.joint = mirrored(detail.joint);
    detail.solid = mirrored(detail.solid);
    check_joints(json, "mirror", {detail.joint});
    recipe_.details.push_back(detail);
  }

  static void read_bands(JsonSection& json, DetailRecipe& detail) {
    double from_deg = 0;
    for (JsonSection& band : json.sections("bands")) {
      detail.bands.push_back({band.number("to_deg", 180, from_deg, 180), band.color("color")});
      from_deg = detail.bands.back().to_deg;
      band.finish();
    }
    if (detail.bands.empty()) json.complain("bands", "must hold at least one colour");
  }

  void read_layer(JsonSection& json, std::vector<PaintLayer>& layers, bool is_color) {
    PaintLayer layer;
    layer.everywhere = json.flag("everywhere", false);
    if (!layer.everywhere) layer.solid = read_solid(json);
    layer.fade_m = json.number("fade_m", 0.02, 1e-4, kFarthest_m);
    layer.strength = json.number("strength", 1, 0, 1);
    layer.facing = json.vector3("facing", layer.facing, -1, 1);
    layer.joints = known_joints(json, "joints");
    if (is_color) layer.color = json.color("color");
    if (!is_color) layer.stiffness = json.number("stiffness", 1, 0, 1);
    const bool both_sides = json.flag("mirror", false);
    json.finish();
    layers.push_back(layer);
    if (!both_sides) return;
    layer.solid = mirrored(layer.solid);
    layer.joints = mirrored(layer.joints);
    layer.facing = mirrored(layer.facing);
    check_joints(json, "mirror", layer.joints);
    layers.push_back(layer);
  }

  void read_skin() {
    if (root_.has("noise")) {
      JsonSection json = root_.section("noise");
      recipe_.noise.strength = json.number("strength", recipe_.noise.strength, 0, 1);
      recipe_.noise.size_m = json.number("size_m", recipe_.noise.size_m, 1e-3, kFarthest_m);
      json.finish();
    }
    if (root_.has("skin")) {
      JsonSection json = root_.section("skin");
      recipe_.skin.overlap_m = json.number("overlap_m", recipe_.skin.overlap_m, 1e-4, 1);
      recipe_.skin.sharpness = json.number("sharpness", recipe_.skin.sharpness, 1, 16);
      recipe_.skin.smooth_m = json.number("smooth_m", recipe_.skin.smooth_m, 0, 0.2);
      json.finish();
    }
  }

  static Axis read_axis(JsonSection& json) {
    const std::string name = json.text("axis");
    const std::vector<std::string> names = {"move_x", "move_y", "move_z", "turn_x", "turn_y", "turn_z"};
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) json.complain("axis", "must be move_x, move_y, move_z, turn_x, turn_y or turn_z");
    return static_cast<Axis>(at - names.begin());
  }

  void read_keys(JsonSection& json, Track& track) {
    for (const Eigen::VectorXd& row : json.rows("keys", 2, -360, 360)) {
      const double after = track.keys.empty() ? -1e-9 : track.keys.back().x();
      if (!(row[0] > after && row[0] < 1))
        json.complain("keys", "must have ascending times from 0 to below 1");
      track.keys.push_back(row);
    }
  }

  void read_wave(JsonSection& json, Track& track) {
    if (!json.has("wave")) return;
    const Eigen::VectorXd wave = json.numbers("wave", 3, -360, 360);
    track.amplitude = wave[0], track.cycles = wave[1], track.phase = wave[2];
    if (json.has("swell")) {
      const Eigen::VectorXd swell = json.numbers("swell", 2, 0, 1);
      if (swell[0] >= swell[1]) json.complain("swell", "must end after it begins");
      track.fade_in = swell[0], track.fade_out = swell[1];
    } else if (track.cycles != std::round(track.cycles)) {
      json.complain("wave", "must have whole cycles to loop, or a \"swell\"");
    }
  }

  void read_track(JsonSection& json, std::vector<Track>& tracks) {
    Track track;
    for (const std::string& name : known_joints(json, "joints"))  // rows like tail_* run down the chain
      for (int joint : matching_joints(recipe_, {name}))
        track.joints.push_back(recipe_.joints[static_cast<size_t>(joint)].name);
    if (track.joints.empty()) json.complain("joints", "must name at least one joint");
    track.axis = read_axis(json);
    track.lag = json.number("lag", 0, -1, 1);
    track.gain = json.number("gain", 1, -10, 10);
    read_keys(json, track);
    read_wave(json, track);
    const std::string other_side = json.text("mirror", "no");
    if (other_side != "no" && other_side != "same" && other_side != "half_cycle_later")
      json.complain("mirror", "must be no, same or half_cycle_later");
    json.finish();
    tracks.push_back(track);
    if (other_side == "no") return;
    tracks.push_back(mirrored(track, other_side == "same" ? 0 : 0.5));
    check_joints(json, "mirror", tracks.back().joints);
  }

  void read_clip(JsonSection& json) {
    ClipRecipe clip;
    clip.name = json.text("name");
    clip.duration_s = json.number("duration_s", 1, 0.05, 600);
    for (JsonSection& track : json.sections("tracks")) read_track(track, clip.tracks);
    json.finish();
    recipe_.clips.push_back(clip);
  }

  JsonSection root_;
  CreatureRecipe recipe_;
};

}  // namespace

CreatureRecipe read_creature_recipe(const std::string& path) {
  const JsonFile file = read_json_file(path);
  return RecipeReader(file).run();
}

}  // namespace sinew::baker
