// bone_names.cpp  Names of bones, as riggers' tools write them, and names that only look like soft parts.
#include "baker/mesh/anatomy/bone_names.hpp"

#include <catch2/catch.hpp>

using namespace sinew::baker;

namespace {

using Words = std::vector<std::string>;

std::optional<SoftKind> kind(const std::string& name) { return meaning_of(name).kind; }

}  // namespace

TEST_CASE("names_that_only_hold_or_qualify_a_soft_word_say_nothing") {
  for (const char* name : {"",
                           "12",
                           "___",
                           "forearm",
                           "LeftForeArm",
                           "rear",
                           "gear_01",
                           "heart",
                           "year",
                           "finger_02",
                           "Finger.l",
                           "detail",
                           "chair",
                           "mainBone",
                           "button",
                           "discipline",
                           "trunkline",
                           "define",
                           "thigh_l",
                           "LeftUpLeg",
                           "DEF-thigh.L.001",
                           "pec_l",
                           "chest",
                           "upper_leg",
                           "Ear_Ring",
                           "hairpin",
                           "HairClip.L",
                           "tail_light",
                           "TailRotor",
                           "cape_pin",
                           "belly_plate",
                           "Skirt_Armor_L",
                           "IKTail",
                           "tail_ctrl",
                           "thigh_twist_01_l",
                           "CC_Base_L_BreastTwist",
                           "ear_l_end",
                           "Bip01 TailNub",
                           "FACIAL_L_Ear",
                           "MCH-tail",
                           "PoleTargetHair"}) {
    INFO(name);
    CHECK_FALSE(kind(name).has_value());
  }
}

TEST_CASE("names_are_split_at_separators_digits_and_changes_of_case") {
  CHECK(words_of("b_Tail01_012") == Words{"b", "tail"});
  CHECK(words_of("mixamorig:LeftUpLeg") == Words{"mixamorig", "left", "upleg"});
  CHECK(words_of("J_Sec_L_Bust1") == Words{"j", "sec", "l", "bust"});
  CHECK(words_of("Ear1.L") == Words{"ear", "l"});
  CHECK(words_of("IKFrontLeg.R") == Words{"ik", "front", "leg", "r"});
  CHECK(words_of("lEar") == Words{"l", "ear"});
  CHECK(words_of("LEar") == Words{"l", "ear"});
  CHECK(words_of("HAIR02") == Words{"hair"});
  CHECK(words_of("Bip01 PonyTail1") == Words{"bip", "ponytail"});
  CHECK(words_of("pony_tail_02") == Words{"ponytail"});
  CHECK(words_of("lefttail") == Words{"tail"});
  CHECK(words_of("tailroot") == Words{"tail"});
}

TEST_CASE("names_of_soft_parts_say_their_kind") {
  const std::vector<std::pair<const char*, SoftKind>> kinds = {{"b_Tail01_012", SoftKind::kTail},
                                                               {"Tail1", SoftKind::kTail},
                                                               {"DEF-tail.003", SoftKind::kTail},
                                                               {"Bip01 Tail", SoftKind::kTail},
                                                               {"Ear1.L", SoftKind::kEar},
                                                               {"lEar", SoftKind::kEar},
                                                               {"HairBall_L", SoftKind::kHair},
                                                               {"HairJoint-6a0f", SoftKind::kHair},
                                                               {"J_Sec_Hair1_01", SoftKind::kHair},
                                                               {"Bip01 Ponytail1", SoftKind::kHair},
                                                               {"PigTail_R", SoftKind::kHair},
                                                               {"Head_Fringe", SoftKind::kHair},
                                                               {"bangs", SoftKind::kHair},
                                                               {"mane_04", SoftKind::kHair},
                                                               {"beard", SoftKind::kHair},
                                                               {"tail_hair", SoftKind::kHair},
                                                               {"J_Sec_L_Bust1", SoftKind::kBreast},
                                                               {"DEF-breast.L", SoftKind::kBreast},
                                                               {"boob_r", SoftKind::kBreast},
                                                               {"pec_jiggle_l", SoftKind::kBreast},
                                                               {"lPectoral", SoftKind::kBreast},
                                                               {"tummy_Armature", SoftKind::kBelly},
                                                               {"BellyBone", SoftKind::kBelly},
                                                               {"glute.L", SoftKind::kGlute},
                                                               {"ButtCheek_L", SoftKind::kGlute},
                                                               {"thigh_jiggle_l", SoftKind::kThigh},
                                                               {"cheek.B.L", SoftKind::kCheek},
                                                               {"jowl_r", SoftKind::kCheek},
                                                               {"dewlap", SoftKind::kOther},
                                                               {"Jiggle01", SoftKind::kOther},
                                                               {"trunk_03", SoftKind::kTrunk},
                                                               {"Proboscis", SoftKind::kTrunk},
                                                               {"tentacle_a_1", SoftKind::kTentacle},
                                                               {"AntennaL", SoftKind::kAntenna},
                                                               {"pectoral_fin_L", SoftKind::kFin},
                                                               {"TailFin", SoftKind::kFin},
                                                               {"cape_01", SoftKind::kCloth},
                                                               {"Cloak.L", SoftKind::kCloth},
                                                               {"J_Sec_L_SkirtBack0", SoftKind::kCloth},
                                                               {"hair_ribbon", SoftKind::kCloth},
                                                               {"sword_tassel", SoftKind::kCloth},
                                                               {"Skirt_Leg_L", SoftKind::kCloth}};
  for (const auto& [name, wanted] : kinds) {
    INFO(name);
    REQUIRE(kind(name).has_value());
    CHECK(defaults_of(*kind(name)).name == std::string(defaults_of(wanted).name));
  }
}

TEST_CASE("names_of_the_body_and_of_helpers_are_told_apart") {
  CHECK(meaning_of("calf_l").body);
  CHECK(meaning_of("Head").face);
  CHECK(meaning_of("mixamorig:RightHandThumb1").body);
  CHECK_FALSE(meaning_of("tail_1").body);
  CHECK_FALSE(meaning_of("Bone.001").body);
  CHECK(meaning_of("ik_hand_gun").helper);
  CHECK_FALSE(meaning_of("ik_hand_gun").body);
}

TEST_CASE("names_of_pieces_are_those_of_hair_hats_and_cloth_unless_they_are_hard") {
  const auto piece = [](const std::string& name) { return meaning_of(name).piece; };
  for (const char* name : {"Helmet", "Hat_Buckle", "Horn.L", "1H_Wand", "2H_Staff", "Spellbook_open", "Sword",
                           "Shield_Badge", "Cape_Clip", "Rogue_Dagger", "Knight_Mask"}) {
    INFO(name);
    CHECK_FALSE(piece(name).has_value());
    CHECK(meaning_of(name).hard);
  }
  CHECK(piece("Mage_Hat") == SoftKind::kHat);
  CHECK_FALSE(meaning_of("Mage_Hat").kind.has_value());  // a bone of that name is no chain
  CHECK(piece("Helmet_Feather") == SoftKind::kFin);      // the last word decides
  CHECK(piece("M_Hair_01") == SoftKind::kHair);
  CHECK(piece("Rogue_Cape") == SoftKind::kCloth);
  for (const char* name : {"Body", "Chatter", "That", "Belly", "Antenna", "Mage_Head"}) {
    INFO(name);
    CHECK_FALSE(piece(name).has_value());
    CHECK_FALSE(meaning_of(name).hard);
  }
}
