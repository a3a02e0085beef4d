// Completed values as the C table takes them.
#pragma once

#include "plugins/values.h"

#include <diatom/abi/core.h>

#include <vector>

namespace diatom {

/// The C form of completed values; the arrays point into `values`.
struct CValues
{
   explicit CValues(const Values &values)
   {
      for (const auto &[parameter, value] : values) {
         name.push_back(parameter.c_str());
         const auto *number = std::get_if<double>(&value);
         numbers.push_back(number ? *number : 0);
         text.push_back(number ? "" : std::get<std::string>(value).c_str());
      }
      record = {sizeof(diatom_values), static_cast<std::int64_t>(name.size()), name.data(), numbers.data(),
                text.data()};
   }
   CValues(const CValues &) = delete;
   CValues &operator=(const CValues &) = delete;

   std::vector<const char *> name, text;
   std::vector<double> numbers;
   diatom_values record{};
};

} // namespace diatom
