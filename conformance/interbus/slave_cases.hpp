#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "conformance/bench_case.hpp"
#include "conformance/interbus/slave_bench.hpp"
#include "conformance/judging.hpp"
#include "conformance/test_case.hpp"

// The test cases for an INTERBUS slave, IS-01 to IS-50 of the catalogue of test purposes, and a canary.
namespace fieldproof::conformance {

using SlaveCase = BenchCase<SlaveBench, SlaveNeeds>;

const std::vector<SlaveCase>& slave_cases();

// One run on a bench of its own. The result has verdict, findings, measurements, seed, fingerprint and
// virtual time; wall time is the caller's to fill. Throws kernel::Error for a position that is not there.
judge::CaseResult run_slave_case(const SlaveCase& slave_case, const SlaveSetting& setting);

// The chapters, each in its own file.
std::vector<SlaveCase> slave_power_up_cases();
std::vector<SlaveCase> slave_id_cycle_cases();
std::vector<SlaveCase> slave_data_cycle_cases();
std::vector<SlaveCase> slave_length_code_cases();
std::vector<SlaveCase> slave_frame_check_cases();
std::vector<SlaveCase> slave_short_cycle_cases();
std::vector<SlaveCase> slave_telegram_cases();
std::vector<SlaveCase> slave_timing_cases();
std::vector<SlaveCase> slave_supervision_cases();
std::vector<SlaveCase> slave_interface_cases();
std::vector<SlaveCase> slave_message_cases();
std::vector<SlaveCase> slave_immunity_cases();
std::vector<SlaveCase> slave_compared_cases();

// ---- what chapters share ----

std::vector<SlaveCase> joined(const std::vector<std::vector<SlaveCase>>& parts);

using Applicability = std::function<std::optional<std::string>(const judge::Pics&)>;
// With outputs, with inputs, with OUT1; or with a PICS item, `sentence` says why it does not apply without.
Applicability for_outputs();
Applicability for_inputs();
Applicability for_remote();
Applicability for_item(const std::string& item, const std::string& sentence);
// For cases whose needs change the rules.
Applicability for_other_settings();
// What each of them applies to.
Applicability for_all(std::vector<Applicability> each);

namespace sources {
judge::Reference park(std::string place);  // the paper whose cycle time the project reproduces
judge::Reference practical_guide(std::string place);
judge::Reference phoenix_maintenance(std::string place);
judge::Reference calculated(std::string place);
judge::Reference derived(std::string place);
judge::Reference from_memory(std::string place);
judge::Reference own(std::string place);
}  // namespace sources

// What cases judge besides and could not verify: the coding of what a slave adds to a cycle. Each with the
// reasons of its findings; see TestCase::details.
namespace details {
PartialSource check_coding();   // check_wrong
PartialSource status_coding();  // status_word_wrong
// The status word of a wrong cycle leaves marked. The message bit of a check error is set.
PartialSource mark(std::vector<std::string> reasons = {"error_not_marked"});
PartialSource message(std::vector<std::string> reasons = {"message_missing"});
// Of expect_answer: header levels, check and status word.
std::vector<PartialSource> answer();
}  // namespace details

}  // namespace fieldproof::conformance
