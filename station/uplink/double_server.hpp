/// For tests: the server's side of the contract in memory, with faults on demand.
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>

#include "station/uplink/server.hpp"
#include "wire/messages.hpp"

namespace tractus::uplink {

/// Keeps uploads as the contract says: announce, chunks at the offset it stands at with their
/// CRC-32C, commit of the whole with its SHA-256. Serves files by path.
class DoubleServer final : public Server {
 public:
  enum class InjectedFault {
    before,
    after
  };                ///< the request is lost; it took effect and the answer is lost
  int fail_at = 0;  ///< the n-th request from now, 1 …; 0: none
  InjectedFault fault = InjectedFault::before;
  std::map<std::string, core::Bytes> files;      ///< path → bytes; Range is honoured
  std::map<std::string, core::Bytes> committed;  ///< trial id → bytes
  std::map<std::string, int> commits;            ///< how often a trial became complete
  std::vector<std::string> log;                  ///< "METHOD path"

  core::Result<HttpResponse> send(const Request& request) override {
    const bool fails = fail_at > 0 && --fail_at == 0;
    const core::Error lost{core::Errc::unavailable, "the line is cut"};
    if (fails && fault == InjectedFault::before) return lost;
    log.push_back(request.method + " " + request.path);
    HttpResponse answer = take(request);
    if (fails) return lost;
    return answer;
  }

 private:
  struct Upload {
    wire::UploadAnnouncement said;
    core::Bytes bytes;
  };
  static HttpResponse reply(int status, const core::Json& json) {
    const std::string text = json.dump();
    const auto bytes = core::bytes_of(text);
    return {status, core::Bytes(bytes.begin(), bytes.end())};
  }
  static HttpResponse refuse(int status, const char* why) {
    return reply(status, {{"error", why}, {"code", "x"}});
  }
  HttpResponse state_of(const std::string& id) {
    const bool complete = committed.contains(id);
    const auto size = complete ? committed[id].size() : uploads_[id].bytes.size();
    return reply(200, {{"offset_bytes", size}, {"state", complete ? "complete" : "receiving"}});
  }
  HttpResponse take(const Request& request) {
    if (request.method == "GET") return file(request);
    if (request.path.ends_with("/there")) return {204, {}};
    const std::string rest = request.path.substr(std::string("/api/v1/uploads/").size());
    const std::string id = rest.substr(0, 32);
    if (request.method == "PUT") return announce(id, request);
    if (!uploads_.contains(id)) return refuse(404, "not announced");
    if (request.method == "PATCH") return chunk(id, rest, request);
    return commit(id);
  }
  HttpResponse file(const Request& request) {
    const auto found = files.find(request.path);
    if (found == files.end()) return refuse(404, "no such thing");
    for (const auto& [name, value] : request.headers) {
      if (name != "Range") continue;
      unsigned long from = 0, to = 0;
      if (std::sscanf(value.c_str(), "bytes=%lu-%lu", &from, &to) != 2 ||
          to >= found->second.size())
        return refuse(416, "no such range");
      return {206, core::Bytes(found->second.begin() + long(from),
                               found->second.begin() + long(to) + 1)};
    }
    return {200, found->second};
  }
  HttpResponse announce(const std::string& id, const Request& request) {
    const auto json = core::parse_json(core::text_of(request.body), "body");
    auto said = wire::UploadAnnouncement::from_json(*json, "body");
    if (!said) return refuse(400, "no announcement");
    const auto [it, fresh] = uploads_.try_emplace(id, Upload{*said, {}});
    if (!fresh && it->second.said.sha256 != said->sha256) return refuse(409, "announced otherwise");
    return state_of(id);
  }
  HttpResponse chunk(const std::string& id, const std::string& rest, const Request& request) {
    Upload& upload = uploads_[id];
    const auto offset = std::stoul(rest.substr(rest.find('=') + 1));
    if (committed.contains(id) || offset != upload.bytes.size())
      return reply(409, {{"error", "another offset"},
                         {"code", "conflict"},
                         {"offset_bytes",
                          committed.contains(id) ? committed[id].size() : upload.bytes.size()}});
    for (const auto& [name, value] : request.headers)
      if (name == "X-Crc32c" && value != fmt::format("{:08x}", core::crc32c(request.body)))
        return refuse(400, "checksum");
    upload.bytes.insert(upload.bytes.end(), request.body.begin(), request.body.end());
    return state_of(id);
  }
  HttpResponse commit(const std::string& id) {
    Upload& upload = uploads_[id];
    if (committed.contains(id)) return state_of(id);
    if (upload.bytes.size() != upload.said.size_bytes ||
        core::sha256(upload.bytes) != upload.said.sha256)
      return refuse(400, "not what was announced");
    committed[id] = upload.bytes;
    ++commits[id];
    return state_of(id);
  }
  std::map<std::string, Upload> uploads_;
};

}  // namespace tractus::uplink
