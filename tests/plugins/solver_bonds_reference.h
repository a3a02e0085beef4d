// Reference data that nothing here was tuned to.
#pragma once

#include "support/support.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <string>

namespace diatom::test {

inline nlohmann::json readReference(const std::string &name)
{
   std::ifstream file(sharedDir() / "validation" / name);
   return nlohmann::json::parse(file);
}

/// Beam theory of each of the reference's models.
inline const std::map<std::string, std::string> kModels{{"a", "thesis"}, {"b", "timoshenko"}, {"c", "euler"}};

} // namespace diatom::test
