// reference_skinning.hpp  A second, plain reading of a glTF file to compare the importer with: JSON, raw
// bytes, recursion, no checks.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

struct ReferenceFile {
  explicit ReferenceFile(const std::string& path);
  ~ReferenceFile();

  int clip_count() const;
  double clip_duration(int clip) const;
  // Scene positions of the vertices of all mesh nodes in file order; clip -1: rest pose.
  std::vector<Eigen::Vector3d> positions(int clip, double t) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
