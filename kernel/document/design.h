// A whole design: what a .diatom file holds. A value; copies are cheap.
#pragma once

#include "assembly/plan.h"
#include "cells/model.h"
#include "document/reference_mesh.h"
#include "scene/setup.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace diatom {

struct Design
{
   std::string name;
   Model model;
   Setup setup;
   AssemblySetup assembly;
   std::vector<ReferenceMesh> referenceMeshes;
   /// Keys this version does not know, by their JSON pointer; written back where they were.
   nlohmann::json unknown = nlohmann::json::object();

   Hash hash() const;
   friend bool operator==(const Design &, const Design &) = default;
};

} // namespace diatom
