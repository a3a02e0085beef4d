#include "verify/verify.h"

#include "verify/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace diatom {

void Tally::add(const CaseReport &report)
{
   for (const Finding &finding : report.findings)
      switch (finding.verdict) {
      case Finding::Verdict::pass:
         ++pass;
         break;
      case Finding::Verdict::fail:
         ++fail;
         break;
      case Finding::Verdict::notComputed:
         ++notComputed;
         break;
      case Finding::Verdict::later:
         ++later;
         break;
      }
}

const char *verdictText(Finding::Verdict verdict)
{
   switch (verdict) {
   case Finding::Verdict::pass:
      return "pass";
   case Finding::Verdict::fail:
      return "FAIL";
   case Finding::Verdict::notComputed:
      return "not computed";
   case Finding::Verdict::later:
      return "not of this solver yet";
   }
   return "";
}

namespace {

Status answer(const Form &form, const Case &one, const Bench &bench, Findings &findings)
{
   try { // the JSON library throws where something is missing; nothing else here does
      return form.answer(one, bench, findings);
   } catch (const nlohmann::json::exception &missing) {
      return Error{
          ErrorCode::unreadable,
          fmt::format("{}: lacks something that the form \"{}\" needs ({}); docs/verification-cases.md says "
                      "what a case holds",
                      one.file.string(), form.name, missing.what())};
   }
}

} // namespace

Result<CaseReport> verifyCase(const Case &one, const std::shared_ptr<const Catalogue> &catalogue,
                              const Job &job)
{
   const auto start = std::chrono::steady_clock::now();
   const auto forms = verificationForms();
   const auto form =
       std::find_if(forms.begin(), forms.end(), [&](const Form &known) { return one.form == known.name; });
   if (form == forms.end())
      return Error{ErrorCode::unsupported,
                   fmt::format("{}: there is no form \"{}\"; diatom verify --list shows those that there are",
                               one.file.string(), one.form)};
   CaseReport report{one.file.string(), one.id, one.form, one.name, "", {}, 0};
   if (const auto said = one.content.find("description"); said != one.content.end() && said->is_string())
      report.description = said->get<std::string>();
   if (!form->answer) {
      for (AskedValue &value : askedValues(one)) {
         Finding finding;
         finding.path = std::move(value.path);
         finding.verdict = Finding::Verdict::later;
         finding.reference = std::move(value.numbers);
         finding.referenceWord = std::move(value.word);
         finding.note = form->later;
         report.findings.push_back(std::move(finding));
      }
      return report;
   }
   Findings findings(one);
   if (const Status answered = answer(*form, one, {catalogue, &job}, findings); !answered)
      return answered.error();
   if (job.cancelled())
      return Error{ErrorCode::cancelled, "cancelled while verifying"};
   report.findings = std::move(findings).take();
   report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
   return report;
}

} // namespace diatom
