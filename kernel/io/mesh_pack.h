// A mesh as bytes, from one process to another of the same program.
#pragma once

#include "core/result.h"
#include "io/mesh_read.h"

#include <string>
#include <string_view>

namespace diatom {

std::string packMesh(const Result<MeshRead> &read);
/// The mesh or the error that was packed.
Result<MeshRead> unpackMesh(std::string_view bytes);

} // namespace diatom
