// A created lattice, parts maker or machine, known by what it answers: what checks of all three kinds need.
#pragma once

#include "core/hash.h"
#include "plugin_check/subject.h"

#include <memory>

namespace diatom::check {

/// Any thread, also at once: so says the contract of these interfaces, and so does this.
class Thing
{
public:
   virtual ~Thing() = default;
   /// All that it answers, byte by byte, hashed: its description and what it makes of fixed inputs.
   virtual Result<Hash> answers(const Job &job) const = 0;
};

/// Whether the kernel looks at it as it would before use: what takes long for lattices.
enum class Look { checked, unchecked };

/// Makes the subject's thing. A refusal of the plugin's own keeps its code; what the kernel finds wrong is
/// ErrorCode::internal.
Result<std::unique_ptr<const Thing>> makeThing(const Subject &subject, const Values &values, const Job &job,
                                               Look look = Look::checked);

/// Of the three, a file each.
Result<std::unique_ptr<const Thing>> makeLatticeThing(const Subject &subject, const Values &values,
                                                      const Job &job, Look look);
Result<std::unique_ptr<const Thing>> makePartsThing(const Subject &subject, const Values &values,
                                                    const Job &job);
Result<std::unique_ptr<const Thing>> makeMachineThing(const Subject &subject, const Values &values,
                                                      const Job &job);

/// What the kernel found wrong, as makeThing() tells it.
inline Error fault(const Error &error)
{
   return {error.code == ErrorCode::cancelled ? error.code : ErrorCode::internal, error.message};
}

} // namespace diatom::check
