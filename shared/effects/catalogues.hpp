/// The catalogues of both rigs as one.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "effects/effect.hpp"

namespace tractus::effects {

/// What is known of an effect of a rig ("probing", "palpation"); null where its catalogue has none
/// of that id.
const EffectFacts* find_facts(std::string_view rig, std::string_view id);

/// How an effect is called within a sentence, of either rig or a user's own; an id that nobody
/// knows, with blanks.
std::string label_of(std::string_view id);

/// The same of every effect of both catalogues, by id.
std::map<std::string, std::string> labels();

}  // namespace tractus::effects
