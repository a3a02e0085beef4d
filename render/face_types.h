// The few polygons a lattice is drawn from: one per site and face, with what the shader needs to draw its
// edges.
#pragma once

#include "lattice/lattice.h"

#include <Eigen/Core>

#include <vector>

namespace diatom::render {

/// A face of the cells of one site, drawn as a triangle fan. Positions are relative to the cell's centre,
/// world axes, m.
struct FaceType
{
   struct Corner
   {
      Eigen::Vector3f position;
      /// Linear over the polygon and of size 1 on its edges: the line between cells is where |edge| nears 1.
      Eigen::Vector4f edge;
   };
   int site = 0, face = 0;
   std::vector<Corner> fan;
   Eigen::Vector3f normal;
};

/// All of a lattice, ordered by site and face: face f of site s is number start[s] + f.
struct FaceTypes
{
   std::vector<FaceType> types;
   std::vector<int> start; // one per site, and the end
};

FaceTypes faceTypes(const Lattice &lattice);

/// Corners of a face of the cell at an index, counter-clockwise from outside, m.
std::vector<Vec3> faceCorners(const Lattice &lattice, Index cell, int face);

} // namespace diatom::render
