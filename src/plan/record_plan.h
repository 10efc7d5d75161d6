#pragma once
// What the planner knows of packed records: which effect writes and which reads them.

#include <string>
#include <vector>

#include "effects/effect.h"

namespace sphgeo {

/// What one effect of a plan does with records.
struct EffectRecords {
  std::string effect;
  Stage stage;
  const std::vector<RecordUse>* uses;
};

/// Whether an effect that uses records as `first` does must run before one of the same stage that
/// uses them as `second`: writers come before readers, readers of the previous value before
/// writers, and readers before who voids the record by writing another one over it.
bool records_precede(const std::vector<RecordUse>& first, const std::vector<RecordUse>& second);

/// Whether `maker` writes fields of a record that `user` reads.
bool serves_records(const std::vector<RecordUse>& maker, const std::vector<RecordUse>& user);

/// Throws std::logic_error that names effect, set and record when two effects write a record in one
/// stage, or when an effect, run in this order through the steps of Algorithm 2, would find a
/// record that no effect has written, or over which another one has been written.
void check_records(const std::vector<EffectRecords>& in_order);

/// One record of a set, as a plan uses it.
struct RecordRow {
  std::string set;
  const RecordSpec* record;
  std::vector<std::string> written_by;  ///< also where it is updated
  std::vector<std::string> read_by;
  std::vector<std::string> used_up_by;  ///< as scratch
  std::vector<std::string>
      shares_with;  ///< records of the same array that void it, or that it voids
};

/// All records of a plan, by set, array and name.
std::vector<RecordRow> record_rows(const std::vector<EffectRecords>& in_order);

}  // namespace sphgeo
