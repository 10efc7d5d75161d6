#include "core/unfinished_files.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>

namespace sphgeo {
namespace {

enum class SlotState { free, changing, file };

struct Slot {
  std::atomic<SlotState> state{SlotState::free};
  std::array<char, 4096> path;
};
static_assert(std::atomic<SlotState>::is_always_lock_free);

// A signal handler can only access variables of static storage.
std::array<Slot, 16> slots;

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) {
  if (path.empty() || path.size() >= slots[0].path.size()) return;
  for (std::size_t k = 0; k < slots.size(); ++k) {
    SlotState expected = SlotState::free;
    if (!slots[k].state.compare_exchange_strong(expected, SlotState::changing)) continue;
    std::memcpy(slots[k].path.data(), path.c_str(), path.size() + 1);
    slots[k].state = SlotState::file;
    slot_ = static_cast<int>(k);
    return;
  }
}

UnfinishedFile::~UnfinishedFile() {
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].state = SlotState::free;
}

void remove_unfinished_files() noexcept {
  for (Slot& s : slots)
    if (s.state == SlotState::file) ::unlink(s.path.data());
}

}  // namespace sphgeo
