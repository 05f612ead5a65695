/// Views of lists that people saved: each sees and changes their own.
#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/finding/saved_views.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::uint64_t kMaxView_bytes = 8192;
constexpr std::size_t kMaxViewName_bytes = 64, kMaxViewSearch_bytes = 2000;

core::Json view_json(const store::SavedView& view) {
  return {{"id", view.id},
          {"page", name(view.page)},
          {"name", view.name},
          {"search", view.search},
          {"made_utc_us", view.made_utc_us}};
}

core::Result<http::Response> views_response(const Call& call) {
  const auto views = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::saved_views_of(tx, call.caller.id); }));
  core::Json list = core::Json::array();
  for (const auto& view : views) list.push_back(view_json(view));
  return json_response({{"views", list}});
}

core::Result<http::Response> add_saved_view(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const store::SavedView view{.id = core::new_id(),
                              .account_id = call.caller.id,
                              .page = fields.word<store::ListedPage>("page"),
                              .name = fields.text("name", kMaxViewName_bytes),
                              .search = fields.text("search", kMaxViewSearch_bytes),
                              .made_utc_us = call.backend.now_utc_us()};
  if (view.name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) { return store::save_view(tx, view); }));
  return views_response(call);
}

core::Result<http::Response> remove_saved_view(const Call& call) {
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::remove_view(tx, call.caller.id, call.text("id")); }));
  return views_response(call);
}

RouteInfo views_route(std::string method, std::string id, std::string summary,
                      core::Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/session/views",
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::director, Role::faculty, Role::researcher, Role::trainee},
          .parameters = {},
          .body = "",
          .answer = "SavedViews",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> saved_views_routes() {
  using namespace schema;
  RouteInfo list =
      views_route("GET", "savedViews", "List the caller's saved views of lists", views_response);
  list.schemas = {
      {"SavedView",
       object({{"id", text("Id of the view, 32 hexadecimal characters")},
               {"page", one_of<store::ListedPage>("Page with the list")},
               {"name", text("Name that the person gave the view")},
               {"search", text("What the page shows, as the part of its address behind the "
                               "question mark")},
               {"made_utc_us",
                integer("us", "Time of saving, in microseconds since 1970-01-01 UTC")}})},
      {"SavedViews",
       object({{"views", array(ref("SavedView"), "Saved views, sorted by page and name")}})}};
  RouteInfo add = views_route("POST", "saveView",
                              "Save a view of a list; it replaces one of the same page and name",
                              add_saved_view);
  add.body = "NewView";
  add.body_limit_bytes = kMaxView_bytes;
  add.schemas = {
      {"NewView",
       object({{"page", one_of<store::ListedPage>("Page with the list")},
               {"name", text("Name of the view, at most 64 bytes")},
               {"search", text("What the page shows, as the part of its address behind the "
                               "question mark; at most 2000 bytes")}})}};
  RouteInfo remove =
      views_route("DELETE", "removeView", "Remove a saved view of the caller", remove_saved_view);
  remove.path += "/{id}";
  remove.parameters = {path_text("id", "Id of the view")};
  return {list, add, remove};
}

}  // namespace api
}  // namespace tractus
