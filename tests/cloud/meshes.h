#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/cloud/triangle.h"

// Meshes whose areas are known.

namespace palp::test {

struct Mesh {
    std::vector<glm::dvec3> vertices; ///< [m]
    std::vector<Triangle>   faces;
};

/// Adds a parallelogram of two triangles, seen from the side of cross(u, v).
inline void addSide(Mesh& mesh, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v)
{
    const auto n = std::uint32_t(mesh.vertices.size());
    for (const glm::dvec3& p : {corner, corner + u, corner + u + v, corner + v}) mesh.vertices.push_back(p);
    mesh.faces.push_back({n, n + 1, n + 2});
    mesh.faces.push_back({n, n + 2, n + 3});
}

/// A square in the plane z = 0.
inline Mesh square(double edge)
{
    Mesh mesh;
    addSide(mesh, {0, 0, 0}, {edge, 0, 0}, {0, edge, 0});
    return mesh;
}

/// A cube about the origin, seen from outside: each side has corners of its own.
inline Mesh cube(double edge)
{
    Mesh         mesh;
    const double h = edge / 2;
    for (int k = 0; k < 3; ++k)
        for (const double side : {-1.0, 1.0}) {
            glm::dvec3 corner(-h), u(0), v(0);
            corner[k]                               = side * h;
            u[side > 0 ? (k + 1) % 3 : (k + 2) % 3] = edge;
            v[side > 0 ? (k + 2) % 3 : (k + 1) % 3] = edge;
            addSide(mesh, corner, u, v);
        }
    return mesh;
}

/// A cube about the origin, seen from outside, whose sides share its 8 corners.
inline Mesh sharedCube(double edge)
{
    Mesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.vertices.push_back(edge * (glm::dvec3(k & 1, k >> 1 & 1, k >> 2) - glm::dvec3(0.5)));
    mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// A ball about the origin: an icosahedron whose triangles are quartered, the new corners put onto the sphere.
inline Mesh ball(double radius, int times)
{
    const double t = std::numbers::phi;
    Mesh         mesh{{{-1, t, 0},
                       {1, t, 0},
                       {-1, -t, 0},
                       {1, -t, 0},
                       {0, -1, t},
                       {0, 1, t},
                       {0, -1, -t},
                       {0, 1, -t},
                       {t, 0, -1},
                       {t, 0, 1},
                       {-t, 0, -1},
                       {-t, 0, 1}},
              {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (; times > 0; --times) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [found, isNew] = middles.try_emplace(std::minmax(a, b), std::uint32_t(mesh.vertices.size()));
            if (isNew) mesh.vertices.push_back(mesh.vertices[a] + mesh.vertices[b]);
            return found->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : mesh.faces) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.faces = std::move(finer);
        for (glm::dvec3& p : mesh.vertices) p = glm::normalize(p);
    }
    for (glm::dvec3& p : mesh.vertices) p *= radius / glm::length(p);
    return mesh;
}

inline double areaOf(const Mesh& mesh)
{
    double area = 0;
    for (const auto& [a, b, c] : mesh.faces)
        area += 0.5 * glm::length(glm::cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
    return area;
}

} // namespace palp::test
