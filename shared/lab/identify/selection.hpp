/// The search over structures: which effects together bring the residual down to the floor.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "lab/identify/diagnosis.hpp"
#include "lab/identify/effect_screen.hpp"

namespace tractus::lab {

/// Every structure that was fitted, kept by its name.
class Selection {
 public:
  Selection(const Residual& residual, const DiagnoseOptions& options,
            const core::Progress& progress);

  /// Fits the base, every single effect, and more together as long as they bring the residual
  /// clearly nearer to the floor. False when asked to stop. @param after_singles  called between.
  bool run(const std::function<void()>& after_singles = {});
  /// The cheapest of those tried so far.
  const Solution& leading() const;

  const Solution& base() const { return tried_.at(""); }
  const Solution& chosen() const { return tried_.at(chosen_); }
  Solution& chosen() { return tried_.at(chosen_); }
  const std::map<std::string, Solution>& tried() const { return tried_; }
  std::map<std::string, Solution>& tried() { return tried_; }
  const std::map<std::string, LinearScreen>& screens() const {
    return screens_;
  }  ///< on the base, by effect
  /// Ids in the order in which they brought most.
  const std::vector<std::string>& order() const { return order_; }
  /// An effect that reached the floor by imitation and is not named for that; empty for none.
  const std::string& refused() const { return refused_; }
  /// Effects that act in free air, too, and are not seen there.
  const std::set<std::string>& unseen_in_air() const { return unseen_in_air_; }
  /// Does the larger bring the residual so much nearer to the floor than the smaller that it is worth growing further?
  bool clearly_better(const Solution& larger, const Solution& smaller) const;
  /// Share by which the larger must lower the error on held-out trials, without weights, below that of the smaller.
  double least_fall(const Structure& larger, const Structure& smaller) const;
  /// Every effect's numbers stand to each other as its law means them.
  bool admissible(const Solution& at) const;

 private:
  Solution& fitted(const Solution& from, const std::string& effect, int tries);
  void keep_better(const std::string& key, Solution found);
  void singles();
  void refine(std::size_t effects);
  void grow();
  void reshape(std::size_t effects);
  void part(const Solution& whole, const Structure& less);
  void simplify(const Structure& whole);
  void choose();
  void refuse_trends();
  void require_free_air();
  void require_lower_error();
  void explain_shifts();
  void explain_shifts_by(const std::string& bias);
  /// The cheapest of a size, most probable first.
  std::vector<const Solution*> best_of(std::size_t effects, std::size_t most) const;
  std::vector<const Solution*> to_grow(std::size_t effects) const;
  bool go_on(double share);

  const Residual& residual_;
  DiagnoseOptions options_;
  const core::Progress& progress_;
  std::map<std::string, Solution> tried_;
  std::map<std::string, LinearScreen> screens_;
  std::set<std::string> refined_;  // fitted to the end since they were last replaced
  std::vector<std::string> order_;
  std::string chosen_, refused_;
  std::set<std::string> unseen_in_air_;
  bool stopped_ = false;
};

/// What a structure costs, in nats: half an effective number of observations times the logarithm of
/// its mean square, how far it moves what was believed, and a price per number added. The effective
/// number is far below that of the samples: what separates structures is not noise but small flaws
/// of any model, which all samples of a trial share.
double cost(const Residual& residual, const Solution& solution, const Solution& base);

/// "" for the base, "a + b" else.
std::string name(const Structure& structure);

/// What a whitened mean square is above the floor, at least a little.
double excess(double mean_square);

}  // namespace tractus::lab
