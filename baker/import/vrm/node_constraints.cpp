// node_constraints.cpp  see node_constraints.hpp.
#include "baker/import/vrm/node_constraints.hpp"

#include <string>

#include "baker/import/gltf/vrm_values.hpp"

namespace sinew::baker {
namespace {

using tinygltf::Value;

constexpr const char* kExtension = "VRMC_node_constraint";
constexpr size_t kMostConstraints = 1000;  // each may follow the next: they are followed by recursion

std::string text(const Value& value) { return value.IsString() ? value.Get<std::string>() : ""; }

// "X" of a roll, "PositiveX" or "NegativeX" of an aim; zero: neither.
Vector3 axis_called(const std::string& name) {
  constexpr const char* kSigned[] = {"PositiveX", "PositiveY", "PositiveZ",
                                     "NegativeX", "NegativeY", "NegativeZ"};
  constexpr const char* kPlain[] = {"X", "Y", "Z"};
  for (int k = 0; k < 6; ++k)
    if (name == kSigned[k]) return (k < 3 ? 1 : -1) * Vector3::Unit(k % 3);
  for (int k = 0; k < 3; ++k)
    if (name == kPlain[k]) return Vector3::Unit(k);
  return Vector3::Zero();
}

Constraint read(const SceneGraph& graph, const Value& stated) {
  const Value& constraint = part(stated, "constraint");
  const Value &roll = part(constraint, "roll"), &aim = part(constraint, "aim");
  Constraint read;
  read.kind = roll.IsObject()  ? ConstraintKind::kRoll
              : aim.IsObject() ? ConstraintKind::kAim
                               : ConstraintKind::kRotation;
  const Value& own = roll.IsObject() ? roll : aim.IsObject() ? aim : part(constraint, "rotation");
  read.source = node_of(graph, part(own, "source"));
  read.weight = number(part(own, "weight"), 1, 0, 1);
  if (roll.IsObject()) read.axis = axis_called(text(part(roll, "rollAxis")));
  if (aim.IsObject()) read.axis = axis_called(text(part(aim, "aimAxis")));
  if (!own.IsObject() || read.axis.isZero(0)) read.source = -1;
  return read;
}

}  // namespace

void read_node_constraints(const tinygltf::Model& model, SceneGraph& graph, Source& source) {
  size_t count = 0;
  for (size_t file = 0; file < model.nodes.size(); ++file) {
    const auto found = model.nodes[file].extensions.find(kExtension);
    if (found == model.nodes[file].extensions.end()) continue;
    if (count == kMostConstraints)
      return source.note("",
                         std::string("more than 1000 nodes with ") + kExtension + ": the rest is left out");
    const int index = graph.node_of_file[file];
    Node& node = graph.nodes[static_cast<size_t>(index)];
    const Constraint constraint = read(graph, found->second);
    if (constraint.source < 0 || constraint.source == index || node.has_matrix)
      source.note("", "node '" + node.name + "': its " + kExtension + " cannot be followed: left out");
    else
      node.constraint = constraint, ++count;
  }
}

}  // namespace sinew::baker
