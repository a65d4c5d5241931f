// Scenes from files, through assimp.
#include "lab/scene.hpp"
#include "lab/scene_builder.hpp"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

namespace lab {
namespace {

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    while (!text.empty() && text.back() == ' ') {
        text.pop_back();
    }
    return text;
}

/// Appends the triangles of a node and its children in world space.
void append_node(scene& world, const aiScene& file, const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 to_world = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh& mesh = *file.mMeshes[node.mMeshes[i]];
        const auto base = world.positions.size();
        if (base + mesh.mNumVertices > 0xffffffffu) {
            throw bad_input("scene '" + world.name + "' has more than 2^32 vertices");
        }
        if (!world.triangles.empty()) {
            world.parts.push_back(world.triangles.size());
        }
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D p = to_world * mesh.mVertices[v];
            world.positions.emplace_back(p.x, p.y, p.z);
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices == 3) {
                world.triangles.push_back(
                    glm::uvec3(static_cast<unsigned>(base)) +
                    glm::uvec3(face.mIndices[0], face.mIndices[1], face.mIndices[2]));
            }
        }
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
        append_node(world, file, *node.mChildren[i], to_world);
    }
}

/// A view from outside a corner of the box, and a sun from above.
void add_default_views(scene& world) {
    const glm::dvec3 centre = 0.5 * (world.box.lo + world.box.hi);
    const double radius = 0.5 * glm::length(world.box.hi - world.box.lo);
    const double fov = glm::radians(50.0);
    const glm::dvec3 from = glm::normalize(glm::dvec3(0.8, 0.55, 1.0));
    world.cameras.push_back(
        {"0", centre + from * (1.05 * radius / std::sin(0.5 * fov)), centre, fov});
    world.lights.push_back({"0", warpshadow::sun(glm::dvec3(0.35, -1.0, 0.25))});
}

} // namespace

scene load_scene(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        throw bad_input("scene file '" + path + "' does not exist");
    }
    if (!std::filesystem::is_regular_file(path, error) || !std::ifstream(path)) {
        throw bad_input("scene file '" + path + "' cannot be read");
    }
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                                aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                    aiComponent_COLORS | aiComponent_TEXCOORDS |
                                    aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                    aiComponent_TEXTURES | aiComponent_LIGHTS |
                                    aiComponent_CAMERAS | aiComponent_MATERIALS);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* file =
        importer.ReadFile(path, aiProcess_RemoveComponent | aiProcess_Triangulate |
                                    aiProcess_SortByPType | aiProcess_JoinIdenticalVertices);
    scene world;
    world.name = std::filesystem::path(path).stem().string();
    if (file != nullptr && file->mRootNode != nullptr) {
        append_node(world, *file, *file->mRootNode, aiMatrix4x4());
    } else if (const std::string reason = one_line(importer.GetErrorString());
               reason != "No meshes remaining") { // what assimp says of points and lines alone
        throw bad_input("scene file '" + path + "' cannot be read: " + reason);
    }
    if (world.triangles.empty()) {
        throw bad_input("scene file '" + path + "' has no triangles");
    }
    for (const glm::vec3& p : world.positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            throw bad_input("scene file '" + path + "' has a vertex that is not finite");
        }
    }
    world.box = box_of(world.positions);
    world.materials.push_back({glm::vec3(0.55f, 0.54f, 0.52f), 0.0f});
    world.material_of.assign(world.triangles.size(), 0);
    add_default_views(world);
    return world;
}

} // namespace lab
