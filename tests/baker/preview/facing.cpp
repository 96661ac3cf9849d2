// facing.cpp  Which way characters look, by the names of their joints.
#include "baker/preview/facing.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace sinew;
using baker::Side;
using baker::side_of;

namespace {

struct Named {
  std::string name;
  float x, z;
};

// A pack of joints alone.
struct Rig {
  std::string strings;
  std::vector<pack::JointRecord> joints;
  pack::CharacterRecord character{};
  pack::PackView view;

  explicit Rig(const std::vector<Named>& named) {
    character.height_m = 2;
    for (const Named& joint : named) {
      pack::JointRecord record{};
      record.name = static_cast<uint32_t>(strings.size());
      strings += joint.name + '\0';
      for (const size_t diagonal : {0, 5, 10}) record.inverse_bind[diagonal] = 1;
      record.inverse_bind[3] = -joint.x;
      record.inverse_bind[7] = -1;
      record.inverse_bind[11] = -joint.z;
      joints.push_back(record);
    }
    view.strings = strings;
    view.joints = joints;
    view.character = &character;
  }
};

float yaw_of(const std::vector<Named>& named) { return baker::facing_yaw_deg(Rig(named).view); }

}  // namespace

TEST_CASE("characters_whose_joints_tell_no_side_look_along_z") {
  CHECK(yaw_of({}) == 0);
  CHECK(yaw_of({{"Bone", 1, 0}, {"Bone.001", -1, 0}}) == 0);
  CHECK(yaw_of({{"arm_l", 1, 0}}) == 0);
  CHECK(yaw_of({{"arm_l", 0, 0}, {"arm_r", 0, 0}}) == 0);
  CHECK(yaw_of({{"arm_l", -1e-5f, 0}, {"arm_r", 1e-5f, 0}}) == 0);
  CHECK(yaw_of({{"arm_l", 0.3f, 1}, {"arm_r", 0.3f, 1}}) == 0);
}

TEST_CASE("sides_are_told_as_common_rigs_name_them") {
  for (const char* left : {"LeftArm", "mixamorig:LeftHand", "b_LeftFoot01_017", "thigh_l", "hand.l", "Ear1.L",
                           "J_Bip_L_UpperArm", "thigh.l_Armature", "Skeleton_arm_joint_L__4_", "L_Clavicle",
                           "FrontLegL", "left", "arm.left.001", "Bip01 L Thigh"}) {
    INFO(left);
    CHECK(side_of(left) == Side::kLeft);
  }
  for (const char* right : {"RightArm", "hand.r", "J_Bip_R_UpperArm", "BackLegR", "b_RightHand_08"}) {
    INFO(right);
    CHECK(side_of(right) == Side::kRight);
  }
  for (const char* neither :
       {"", "root", "Tail1", "pelvis", "Lower", "leftover", "Roll", "BIRL", "head", "ball"}) {
    INFO(neither);
    CHECK(side_of(neither) == Side::kNone);
  }
}

TEST_CASE("characters_look_to_where_their_left_is_on_the_left") {
  CHECK(yaw_of({{"arm_l", 1, 0}, {"arm_r", -1, 0}}) == Approx(0).margin(1e-4));
  CHECK(std::abs(yaw_of({{"arm_l", -1, 0}, {"arm_r", 1, 0}})) == Approx(180));
  CHECK(yaw_of({{"LeftLeg_01", 0, -1}, {"RightLeg_02", 0, 1}}) == Approx(90));
  // Several on a side, whatever their numbers.
  CHECK(yaw_of({{"Leg.L", 1, 3}, {"Arm.L", 3, 3}, {"Arm.R", -2, 3}}) == Approx(0).margin(1e-4));
}
