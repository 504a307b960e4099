#include "field/blend/mean_bounds.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double roundings = 1e-9;
// Weights change by e^(slope rho) at most, but for a factor that all share. Beyond this nothing is worth knowing.
constexpr double largest_change = 6;

// The largest share of each term anywhere in the ball; nothing where a term is not bounded.
std::vector<double> largest_shares(std::span<const MeanTerm> terms, double rho) {
  for (const MeanTerm& t : terms)
    if (!(t.slope * rho < largest_change && t.bend < inf && t.value_slope < inf && t.value_bend < inf)) return {};
  std::vector<double> shares;
  shares.reserve(terms.size());
  double least = 0;
  for (const MeanTerm& t : terms) {
    const double grows = exp(t.slope * rho);
    least += t.weight / grows;
    shares.push_back(t.weight * grows);
  }
  if (!(least > 0 && least < inf)) return {};
  for (double& share : shares) share = std::min(1.0, share / least * (1 + roundings));
  return shares;
}

}  // namespace

MeanChange mean_change(std::span<const MeanTerm> terms, double widest, double rho) {
  const std::vector<double> shares = largest_shares(terms, rho);
  if (shares.empty()) return {inf, inf};
  double steepest = 0, mean_slope = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    steepest = std::max(steepest, terms[i].slope);
    mean_slope += shares[i] * terms[i].slope;
  }
  mean_slope = std::min(mean_slope, steepest);
  // How far values are from the mean depends on how far that moves: first anywhere, then as was found before.
  constexpr int rounds = 3;
  MeanChange mean{inf, inf};
  for (int round = 0; round < rounds; ++round) {
    const double moved = std::min(widest, mean.slope * rho);
    const auto apart = [&](const MeanTerm& t) { return std::min(widest, t.apart + t.value_slope * rho + moved); };
    double slope = 0, bend = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
      slope += shares[i] * (apart(terms[i]) * terms[i].slope + terms[i].value_slope);
    mean.slope = std::min(mean.slope, slope * (1 + roundings));
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const MeanTerm& t = terms[i];
      bend += shares[i] * ((t.slope + mean_slope) * (apart(t) * t.slope + t.value_slope) +
                           (t.value_slope + mean.slope) * t.slope + apart(t) * t.bend + t.value_bend);
    }
    mean.bend = std::min(mean.bend, bend * (1 + roundings));
  }
  return mean;
}

double log_bend(std::span<const MeanTerm> terms, double rho) {
  const std::vector<double> shares = largest_shares(terms, rho);
  if (shares.empty()) return inf;
  double bend = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) bend += shares[i] * (terms[i].bend + terms[i].slope * terms[i].slope);
  return bend * (1 + roundings);
}

}  // namespace marrow
