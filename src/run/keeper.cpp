#include "run/keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/version.h"

namespace sphgeo {

template <int Dim>
Keeper<Dim>::Keeper(RunParts<Dim> parts, const RunFolder& folder, const Spent& before,
                    double processor_start)
    : parts_(parts), folder_(folder), before_(before), processor_start_(processor_start) {}

template <int Dim>
void Keeper<Dim>::keep_if_due(double wall_seconds) {
  // Fifty times the duration of the last one: checkpoints never cost more than 2 % of a run.
  const double interval = std::max(parts_.model.output.checkpoint_every, 50 * last_seconds());
  // While files are still being written it would have to wait for them.
  if (wall_seconds - kept_at_ >= interval && parts_.recorder.files().idle()) keep(wall_seconds);
}

template <int Dim>
void Keeper<Dim>::keep(double wall_seconds) {
  const double spent_before = spent_.seconds;
  begin(wall_seconds);
  last_held_up_ = spent_.seconds - spent_before;
  ++count_;
  kept_at_ = wall_seconds + last_held_up_;
}

template <int Dim>
void Keeper<Dim>::begin(double wall_seconds) {
  const Stopwatch watch(spent_);
  parts_.stepper.guard().check_all();
  SideThread& files = parts_.recorder.files();
  files.wait();  // what it writes takes memory as well
  const Model& model = parts_.model;
  std::size_t expected = 0;
  for (const auto& set : parts_.world.sets())
    for (const auto& [name, field] : set->fields())
      if (field->spec().lifetime != Lifetime::derived) expected += field->value_bytes();
  const auto state = std::make_shared<CheckpointWriter>(expected);
  CheckpointWriter& file = *state;
  file.put_text("version", version());
  file.put_text("deck/decisive", decisive_yaml(model));
  file.put_text("deck/resolved", resolved_yaml(model));
  file.put_count("dimension", Dim);
  put_spent(file, "spent", so_far(wall_seconds));
  parts_.world.save(file);
  parts_.stepper.save(file);
  parts_.plan.save(file);
  parts_.recorder.save(file);
  bytes_ = file.finish();
  // The task may outlive the keeper, where the run ends by an exception.
  files.begin([&recorder = parts_.recorder, path = folder_.checkpoint(),
               previous = folder_.previous_checkpoint(), state, writing = writing_] {
    const auto start = std::chrono::steady_clock::now();
    recorder.wait_for_disk();  // the tables are at least as long as the checkpoint says
    state->write(path, previous);
    const double seconds = seconds_since(start);
    writing->last = seconds;
    writing->all = writing->all + seconds;
  });
}

void require_same_deck(const Model& model, const CheckpointReader& checkpoint) {
  const std::string there = checkpoint.text("deck/decisive"), here = decisive_yaml(model);
  if (there == here) return;
  Diagnostics found;
  const std::vector<std::string> keys = differing_keys(there, here);
  for (std::size_t k = 0; k < std::min<std::size_t>(keys.size(), 20); ++k) {
    const std::string path = keys[k].substr(0, keys[k].find(": "));
    found.error("E130", model.place_of(path), path,
                "this key may not change when a run is resumed: " + keys[k],
                "set it back, or start anew in another folder");
  }
  throw DeckError(found);
}

template class Keeper<2>;
template class Keeper<3>;

}  // namespace sphgeo
