#include "server/api/operations/messages.hpp"

#include "core/json.hpp"

namespace tractus {
namespace api {
namespace {

using Catalogues = std::map<std::string, std::map<std::string, std::string>, std::less<>>;

/// A file that is no table of texts has no sentences (messages_test.cpp tells of it).
const Catalogues& catalogues() {
  static const Catalogues kCatalogues = [] {
    Catalogues out;
    for (const auto& [language, text] : message_files()) {
      auto& catalogue = out[std::string(language)];
      const auto json = core::parse_json(text, std::string(language));
      if (!json || !json->is_object()) continue;
      for (const auto& [english, translation] : json->items())
        catalogue[english] = core::text_member(*json, english.c_str());
    }
    return out;
  }();
  return kCatalogues;
}

}  // namespace

const std::vector<std::string>& languages() {
  static const std::vector<std::string> kLanguages = [] {
    std::vector<std::string> out{"en"};
    for (const MessageFile& file : message_files()) out.emplace_back(file.language);
    return out;
  }();
  return kLanguages;
}

std::string translated(const std::string& english, std::string_view language) {
  const auto catalogue = catalogues().find(language);
  if (catalogue == catalogues().end()) return english;
  const auto found = catalogue->second.find(english);
  return found == catalogue->second.end() || found->second.empty() ? english : found->second;
}

std::string filled_in(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text[at] == '{' ? text.find('}', at) : std::string_view::npos;
    const auto value = end == std::string_view::npos
                           ? values.end()
                           : values.find(std::string(text.substr(at + 1, end - at - 1)));
    if (value == values.end()) {
      out += text[at++];
    } else {
      out += value->second;
      at = end + 1;
    }
  }
  return out;
}

}  // namespace api
}  // namespace tractus
