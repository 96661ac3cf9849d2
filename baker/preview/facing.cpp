// facing.cpp  see facing.hpp.
#include "baker/preview/facing.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cctype>
#include <cmath>

namespace sinew::baker {
namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }

// A word begins at an upper-case letter after none, or after what is no letter.
bool begins_word(std::string_view name, size_t at) {
  return at == 0 || !is_letter(name[at - 1]) || (is_upper(name[at]) && !is_upper(name[at - 1]));
}

bool ends_word(std::string_view name, size_t end) { return end == name.size() || !is_lower(name[end]); }

bool has_word(std::string_view name, std::string_view lower) {
  for (size_t at = 0; at + lower.size() <= name.size(); ++at) {
    if (!begins_word(name, at) || !ends_word(name, at + lower.size())) continue;
    bool same = true;
    for (size_t i = 0; i < lower.size(); ++i)
      same = same && std::tolower(static_cast<unsigned char>(name[at + i])) == lower[i];
    if (same) return true;
  }
  return false;
}

Eigen::Vector3f place_of(const pack::JointRecord& joint) {
  Eigen::Transform<float, 3, Eigen::Affine> inverse = Eigen::Transform<float, 3, Eigen::Affine>::Identity();
  inverse.affine() = Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(joint.inverse_bind);
  return inverse.inverse().translation();
}

}  // namespace

Side side_of(std::string_view joint_name) {
  const bool left = has_word(joint_name, "left") || has_word(joint_name, "l");
  const bool right = has_word(joint_name, "right") || has_word(joint_name, "r");
  if (left == right) return Side::kNone;
  return left ? Side::kLeft : Side::kRight;
}

float facing_yaw_deg(const pack::PackView& character) {
  Eigen::Vector3f sum[2] = {Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  float count[2] = {0, 0};
  for (const pack::JointRecord& joint : character.joints) {
    const Side side = side_of(pack::string_at(character, joint.name));
    if (side == Side::kNone) continue;
    sum[side == Side::kRight] += place_of(joint);
    ++count[side == Side::kRight];
  }
  if (count[0] == 0 || count[1] == 0) return 0;
  Eigen::Vector3f left = sum[0] / count[0] - sum[1] / count[1];
  left.y() = 0;
  constexpr float kLeast = 1e-3f, kDegrees = 57.29578f;  // of the height: nearer together they say nothing
  if (!(left.norm() > kLeast * character.character->height_m)) return 0;
  const Eigen::Vector3f ahead = left.cross(Eigen::Vector3f::UnitY());
  return kDegrees * std::atan2(ahead.x(), ahead.z());
}

}  // namespace sinew::baker
