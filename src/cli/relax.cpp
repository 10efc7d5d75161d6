#include <iostream>

#include "cli/commands.h"
#include "relax/relax_deck.h"
#include "run/relaxation_report.h"

namespace sphgeo {
namespace {

class Findings final : public RunObserver {
  void findings(const Diagnostics& found) override { std::cerr << found.render(); }
};

}  // namespace

int relax_command(const RelaxOptions& options) {
  RunSettings settings;  // its clock starts before the deck is read
  settings.deck = options.deck;
  settings.folder = options.folder;
  settings.existing = options.overwrite ? ExistingResults::overwrite : ExistingResults::refuse;
  settings.threads = options.threads;
  settings.verify = options.verify;
  const Model model = read_deck(options.deck, options.set);
  Findings findings;
  const auto [water, summary] = relax_deck(model, settings, findings);
  if (!options.quiet) std::cerr << relaxation_line(model, water) << "\n";
  if (!summary.expect.empty()) std::cout << render_expectations(summary.expect);
  return summary.exit_code;
}

}  // namespace sphgeo
