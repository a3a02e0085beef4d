// What became of the values that a case asks for: each is computed and compared, or it is said why not.
#pragma once

#include "verify/case_file.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace diatom {

/// How far a computed value may be from its reference.
struct Tolerance
{
   enum class Measure {
      largest, // largest difference over the largest number of the reference, or over `scale`
      each     // largest of the numbers' own relative differences
   };
   double most = 0;
   Measure measure = Measure::largest;
   double scale = 0;      // of the difference; 0 = the reference's own size
   std::string words;     // what the difference is told in; empty = relative
   std::size_t first = 0; // how many of the numbers count; 0 = all

   static Tolerance relative(double most) { return {most, Measure::largest, 0, "", 0}; }
   static Tolerance each(double most) { return {most, Measure::each, 0, "", 0}; }
   static Tolerance of(double most, double scale, std::string words)
   {
      return {most, Measure::largest, scale, std::move(words), 0};
   }
   static Tolerance absolute(double most) { return {most, Measure::largest, 1, "absolute", 0}; }
};

struct Finding
{
   enum class Verdict { pass, fail, notComputed, later };
   std::string path; // or the name of a check of the case that has no value of its own
   Verdict verdict = Verdict::notComputed;
   std::vector<double> computed, reference;
   std::string computedWord, referenceWord; // of a word
   double error = 0, tolerance = 0;
   std::string measure; // of the error
   std::string note;    // why it was not computed or failed, or against what else than its own it was held
   bool compared() const { return !computed.empty() || !computedWord.empty(); }
};

/// Collects the findings of one case.
class Findings
{
public:
   explicit Findings(const Case &one);

   /// Holds a value against the reference at `path`. Several may be held against one.
   void compare(const std::string &path, std::span<const double> computed, const Tolerance &tolerance,
                std::string note = "");
   void compare(const std::string &path, double computed, const Tolerance &tolerance, std::string note = "")
   {
      compare(path, std::span(&computed, 1), tolerance, std::move(note));
   }
   /// Holds a word against the one at `path`.
   void compareWord(const std::string &path, std::string computed);
   /// Something that the case wants to hold beside its values: `computed` may be `most` at most.
   void check(const std::string &name, double computed, double most, std::string note = "");
   /// Why the values that match the pattern, and have no finding of their own, were not computed.
   void skip(std::string pattern, std::string why);
   /// What came instead of the values that match the pattern and have no finding: they fail.
   void fail(std::string pattern, std::string why);

   /// In the order of the file, then the checks.
   std::vector<Finding> take() &&;

private:
   struct Reason
   {
      std::string pattern, why;
      bool failed = false;
   };
   Finding missing(const AskedValue &value) const;
   std::size_t numberOf(const std::string &path) const;

   std::vector<AskedValue> m_asked;
   std::vector<std::vector<Finding>> m_found; // of each asked value
   std::vector<Finding> m_checks;
   std::vector<Reason> m_reasons;
};

} // namespace diatom
