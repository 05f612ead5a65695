/// What e-mails say, in the languages that have a catalogue: messages/LANGUAGE.json, the English
/// sentence on the left, its translation on the right (ADR-0053).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tractus::api {

/// The file of a language, as it is in the sources.
struct MessageFile {
  std::string_view language, json;
};
/// By language.
const std::vector<MessageFile>& message_files();
/// English and each language that has a file.
const std::vector<std::string>& languages();

/// An English sentence in a language; where the language or the sentence is unknown, in English.
std::string translated(const std::string& english, std::string_view language);
/// The text with its {names} filled in; a name without a value stays.
std::string filled_in(std::string_view text, const std::map<std::string, std::string>& values);

}  // namespace tractus::api
