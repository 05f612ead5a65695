/// Effects that a user wrote and that a structure may name beside the catalogue's.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "effects/effect.hpp"

namespace tractus::lab {

/// Each with what is known of it; the pointers stay with the object.
class UserEffects {
 public:
  UserEffects() = default;
  explicit UserEffects(
      std::vector<std::pair<effects::EffectInstance, effects::EffectFacts>> effects)
      : effects_(std::move(effects)) {}

  /// Null for an id that is not among them.
  const effects::EffectFacts* facts(std::string_view id) const {
    for (const auto& [use, facts] : effects_)
      if (use.id == id) return &facts;
    return nullptr;
  }
  /// As it stands in a model: with the formula, if it is one of these.
  effects::EffectInstance use(std::string_view id, std::vector<double> values) const {
    for (const auto& [use, facts] : effects_)
      if (use.id == id) return {use.id, std::move(values), use.definition};
    return {std::string(id), std::move(values), {}};
  }
  const std::vector<std::pair<effects::EffectInstance, effects::EffectFacts>>& all() const {
    return effects_;
  }
  void add(const UserEffects& more) {
    effects_.insert(effects_.end(), more.effects_.begin(), more.effects_.end());
  }

 private:
  std::vector<std::pair<effects::EffectInstance, effects::EffectFacts>> effects_;
};

}  // namespace tractus::lab
