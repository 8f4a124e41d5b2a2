// Text of MaterialX documents that both kinds of material share.
#pragma once

#include <string>

#include "lobefit/export/targets/target.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Nodes of the mesh's tangent, bitangent and normal.
std::string MeshFrame();

// Nodes of the tangent and the normal where they are not the mesh's, and the inputs that name them.
struct FrameText {
  std::string nodes, tangent = "mesh_tangent", normal = "mesh_normal";
};
FrameText FrameNodes(const std::string& prefix, double rotation, const Vec3& normal);

std::string MaterialXDocument(const WriteContext& context, const std::string& nodes);

}  // namespace lobefit
