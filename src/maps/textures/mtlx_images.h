// Nodes of MaterialX that read textures, for both of its targets.
#pragma once

#include <string>

#include "lobefit/maps/textures/texture.h"

namespace lobefit {

// An image; `type` is color3, vector3 or float. Files are named beside the document.
std::string ImageNode(const std::string& name, const std::string& file, const std::string& type);

// The normal of the map and, made perpendicular to it, the mesh's tangent or the one that the map of directions turns:
// the nodes ID_normal and ID_tangent. Needs MeshFrame.
std::string MapFrameNodes(const std::string& id, const std::string& name, bool directions);

// The picture of directions that MapFrameNodes takes.
Texture DirectionTexture();

// The material ID of the surface shader ID_surface.
std::string MaterialNode(const std::string& id);

}  // namespace lobefit
