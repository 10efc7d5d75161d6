#include "study/price.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace sphgeo;

TEST_SUITE_BEGIN("study");

namespace {

const ErrorScale per_cent{true, 0.02, "the reference"};

bool says(const std::string& text, const std::string& part) {
  const bool found = text.find(part) != std::string::npos;
  if (!found) MESSAGE(text);
  return found;
}

}  // namespace

TEST_CASE("an error of first order and a time of third: the sentence reads both off the ladder") {
  const std::vector<Offer> offers = {
      {"0.04", 0.04, 60, 0.04}, {"0.02", 0.02, 480, 0.02}, {"0.01", 0.01, 3840, 0.01}};
  const std::string text = price_of_spacing(offers, per_cent);
  CHECK(says(text, "2 % (the deck's tolerance) needs dp 0.02 (about 8 min)"));
  CHECK(says(text, "1 % needs dp 0.01 (about 64 min)"));
  CHECK(says(text, "0.5 % needs about dp 0.005 (about 9 h)"));
}

TEST_CASE("beyond a quarter of the finest spacing nothing is promised") {
  const std::vector<Offer> offers = {{"0.02", 0.02, 1, 0.11}, {"0.01", 0.01, 8, 0.1}};
  CHECK(says(price_of_spacing(offers, per_cent),
             "2 % (the deck's tolerance) is out of reach of these runs"));
}

TEST_CASE("an error that does not fall is said to do so") {
  const std::vector<Offer> offers = {{"0.02", 0.02, 1, 0.1}, {"0.01", 0.01, 8, 0.12}};
  CHECK(says(price_of_spacing(offers, per_cent),
             "the error against the reference does not fall: 10 % at dp 0.02"));
}

TEST_CASE("an order above two is not taken further than two") {
  const std::vector<Offer> offers = {{"0.02", 0.02, 1, 0.8}, {"0.01", 0.01, 8, 0.01}};
  const std::string text = price_of_spacing(offers, {true, 0, ""});
  CHECK(says(text, "0.5 % needs about dp 0.0071"));
  CHECK(says(text, "by chance"));
}

TEST_CASE("without a ladder there is no price") {
  CHECK(says(price_of_spacing(std::vector<Offer>{{"1", 1, 1, 0.1}}, per_cent), "a single run"));
  CHECK(says(price_of_spacing(std::vector<Offer>{{"1", 1, 1, {}}, {"2", 0.5, 1, {}}}, per_cent),
             "a single run"));
}

TEST_CASE("settings of another key: the cheapest within tolerance is named") {
  const std::vector<Offer> offers = {
      {"1.3", 0.01, 10, 0.03}, {"1.6", 0.01, 20, 0.015}, {"1.8", 0.01, 30, 0.01}};
  const std::string text = price_of_settings(offers, per_cent);
  CHECK(says(text, "1.3: 3 % in 10 s; 1.6: 1.5 % in 20 s"));
  CHECK(says(text, "the cheapest within tolerance is 1.6"));
}

TEST_CASE("the Pareto front leaves out what another beats in both, and one of two equals") {
  const std::vector<Offer> offers = {{"a", 1, 10, 0.1},
                                     {"b", 1, 20, 0.05},
                                     {"c", 1, 30, 0.06},
                                     {"d", 1, 5, {}},
                                     {"e", 1, 10, 0.1}};
  CHECK(worth_their_time(offers) == std::vector<bool>{true, true, false, false, false});
}

TEST_SUITE_END();
