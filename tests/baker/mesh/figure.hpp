// figure.hpp  Small characters of named bones and simple flesh, for tests of what names say.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"

struct Figure {
  sinew::baker::Character character;

  explicit Figure(const std::string& name) { character.name = name; }

  // Returns the joint. parent -1: the root.
  int joint(const std::string& name, int parent, const sinew::baker::Vector3& place);
  // Joints in a row below `parent`, from `begin` in equal steps; NAME1, NAME2, ... with an end site. All of
  // them.
  std::vector<int> chain(const std::string& name, int parent, const sinew::baker::Vector3& begin,
                         const sinew::baker::Vector3& step, int count);
  // A node without skin at the joint's end.
  void end_site(int joint, const sinew::baker::Vector3& offset);

  // A closed tube from the first joint's place over the others' to `end`; skin blends from joint to joint.
  // One joint alone: a piece that is fastened to it.
  void tube(const std::vector<int>& joints, const sinew::baker::Vector3& end, double radius);
  // The same, and flat: an open strip of this half width.
  void sheet(const std::vector<int>& joints, const sinew::baker::Vector3& end,
             const sinew::baker::Vector3& half_width);
  // A ball of flesh about `joint`'s place that it moves by at most 0.4 at its front (+Z), `on` by the rest.
  void bulge(int joint, int on, double radius);
  // What was added since the last call is a mesh of this name.
  void mesh(const std::string& name, bool skinned);

  sinew::baker::Vector3 place(int joint) const;

 private:
  int vertex(const sinew::baker::Vector3& place, const sinew::baker::Vector3& normal,
             const sinew::baker::Influences& skin);
  size_t meshed_ = 0;
};
