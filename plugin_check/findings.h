// What a check found.
#pragma once

#include <string>
#include <vector>

namespace diatom::check {

/// In the order in which the worst is told.
enum class Severity { pass, skipped, warning, failure };

struct Finding
{
   Severity severity = Severity::pass;
   std::string text;
};

class Findings
{
public:
   void skip(std::string text) { add(Severity::skipped, std::move(text)); }
   void warn(std::string text) { add(Severity::warning, std::move(text)); }
   void fail(std::string text) { add(Severity::failure, std::move(text)); }
   void add(Severity severity, std::string text)
   {
      m_all.push_back({severity, m_about.empty() ? std::move(text) : m_about + ": " + text});
   }
   /// Put before what is found from now on; "" for nothing.
   void about(std::string subject) { m_about = std::move(subject); }
   const std::vector<Finding> &all() const { return m_all; }

private:
   std::vector<Finding> m_all;
   std::string m_about;
};

inline Severity worst(const std::vector<Finding> &findings)
{
   Severity severity = Severity::pass;
   for (const Finding &finding : findings)
      severity = finding.severity > severity ? finding.severity : severity;
   return severity;
}

} // namespace diatom::check
