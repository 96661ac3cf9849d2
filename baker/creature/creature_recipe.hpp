// creature_recipe.hpp  What the artist states about a creature. Metres, Y up, the creature looks along +Z,
// its left is +X.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

namespace sinew::baker {

struct Solid {  // an implicit primitive; an ellipsoid when `points` is empty, else a tube through the points
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();  // about Z, then X, then Y
  std::vector<Eigen::Vector4d> points;                 // x, y, z, radius
  Eigen::Vector3d flat_axis = Eigen::Vector3d::UnitZ();
  double flat = 1;  // thickness of the tube along flat_axis as a share of its width
};

struct JointRecipe {
  std::string name, parent;  // parents come first
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  // end of the bone
};

struct LimbRecipe {  // two bones that keep their end where the clips put it
  std::string upper, lower, end;
  Eigen::Vector3d bend = Eigen::Vector3d::UnitZ();  // side the middle joint points to
};

struct BodyPart {
  std::string name;
  Solid solid;
  double blend_m = 0.03;            // width of the smooth union with the parts before it
  bool carve = false;               // taken away instead of added
  double edge_scale = 1;            // edge length of the mesh here relative to the rest
  std::vector<std::string> joints;  // that may move it
};

struct ColorBand {
  double to_deg = 180;  // from the pole that faces +Z before turning
  Eigen::Vector3d color = Eigen::Vector3d::Ones();
};

struct DetailRecipe {  // a small closed surface of its own, moved rigidly by one joint
  std::string name, joint, material;
  Solid solid;           // an ellipsoid, or a tube
  bool snap = false;     // the points of a tube are moved onto the body's surface
  double cap_deg = 180;  // less than 180: only the cap around the pole, with an inner face (an eyelid)
  double share = 0.01;   // of the creature's vertices
  std::vector<ColorBand> bands;
};

struct PaintLayer {  // a brush: full strength inside the solid, fading to nothing over `fade_m` outside it
  bool everywhere = false;
  Solid solid;
  double fade_m = 0.02, strength = 1;
  Eigen::Vector3d facing =
      Eigen::Vector3d::Zero();      // zero: any normal; else only where the normal points this way
  std::vector<std::string> joints;  // empty: any; else only where these move the skin
  Eigen::Vector3d color = Eigen::Vector3d::Ones();  // of a colour layer, sRGB
  double stiffness = 1;                             // of a stiffness layer
};

struct MaterialRecipe {
  std::string name;
  double roughness = 0.9;
  Eigen::Vector3d emissive = Eigen::Vector3d::Zero();
};

enum class Axis { kMoveX, kMoveY, kMoveZ, kTurnX, kTurnY, kTurnZ };

struct Track {  // adds to one axis of a row of joints, each later than the one before by `lag` of the clip
  std::vector<std::string> joints;
  Axis axis = Axis::kTurnX;
  double lag = 0, gain = 1;                     // each joint's amplitude is the one before times gain
  std::vector<Eigen::Vector2d> keys;            // share of the clip, metres or degrees; periodic
  double amplitude = 0, cycles = 1, phase = 0;  // amplitude sin(2 pi (cycles t + phase)), added to the keys
  double fade_in = 0, fade_out = 1;  // shares of the clip between which the wave swells and dies away
};

struct ClipRecipe {
  std::string name;
  double duration_s = 1;
  std::vector<Track> tracks;
};

struct SkinRecipe {
  double overlap_m = 0.03;  // parts closer than this to the surface share its weights
  double sharpness = 4;     // power of the inverse distance to a part's bones
  double smooth_m = 0.03;   // width of the smoothing along the surface
};

struct NoiseRecipe {
  double strength = 0.04, size_m = 0.03;
};

struct CreatureRecipe {
  std::string name;
  size_t vertices = 7000;
  double key_rate_hz = 30;
  std::vector<JointRecipe> joints;
  std::vector<LimbRecipe> limbs;
  std::vector<BodyPart> body;
  std::vector<DetailRecipe> details;
  std::vector<MaterialRecipe> materials;  // the first is the body's
  std::vector<PaintLayer> coat;           // colours, later layers over earlier ones
  std::vector<PaintLayer> tissue;         // stiffness, likewise
  NoiseRecipe noise;
  SkinRecipe skin;
  std::vector<Track> stance;  // added to every clip
  std::vector<ClipRecipe> clips;
};

}  // namespace sinew::baker
