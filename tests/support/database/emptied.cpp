#include "tests/support/database/emptied.hpp"

#include <algorithm>

#include "core/require.hpp"
#include "db/store/store.hpp"
#include "tests/support/postgres/postgres_server.hpp"

namespace tractus {
namespace test_support {
namespace {

constexpr int kMostUses = 50;  // rows that were taken away stay in the files until then

/// The schema `unused` holds what a database is emptied by: the rows that it had when it was new,
/// what its schema was, and a function that puts them back. False: its schema has changed.
constexpr const char* kUnused = R"(
create schema unused;
create function unused.tables() returns setof text language sql as $$
  select relname::text from pg_class
  where relnamespace = 'public'::regnamespace and relkind = 'r' $$;
create function unused.now() returns text language sql as $$
  select md5(coalesce(string_agg(line, ';' order by line), '')) from (
    select format('%s.%s %s %s', attrelid::regclass, attname, atttypid, attnotnull) as line
    from pg_attribute join pg_class on pg_class.oid = attrelid
    where relnamespace = 'public'::regnamespace and attnum > 0
    union all select indexdef from pg_indexes where schemaname = 'public'
    union all select format('%s %s', conrelid::regclass, pg_get_constraintdef(oid))
      from pg_constraint where connamespace = 'public'::regnamespace
    union all select format('%s %s', tgname, tgenabled) from pg_trigger where not tgisinternal
    union all select proname from pg_proc where pronamespace = 'public'::regnamespace) lines $$;
create function unused.put_back() returns boolean language plpgsql as $$
  declare name text; used boolean;
  begin
    if unused.now() <> (select mark from unused.marks) then return false; end if;
    set local session_replication_role = replica;
    for name in select unused.tables() loop
      execute format('select exists (select 1 from public.%I)', name) into used;
      if used then execute format('delete from public.%I', name); end if;
      if to_regclass(format('unused.%I', name)) is not null then
        execute format('insert into public.%I select * from unused.%I', name, name);
      end if;
    end loop;
    return true;
  end $$;
do $$
  declare name text; used boolean;
  begin
    for name in select unused.tables() loop
      execute format('select exists (select 1 from public.%I)', name) into used;
      if used then execute format('create table unused.%I as table public.%I', name, name); end if;
    end loop;
  end $$;
create table unused.marks as select unused.now() as mark;
)";

}  // namespace

const std::string& EmptiedDatabases::model() {
  if (!model_.empty()) return model_;
  model_ = postgres_server().add_database();
  const std::string address = postgres_server().address(model_);
  {
    auto opened = store::Store::open_postgres(address);
    core::require(bool(opened), opened ? "" : opened.error().what.c_str());
  }
  auto connection = store::postgres_connection(address, store::Access::write);
  const bool begun = connection->begin(store::Access::beside) && connection->commit();
  core::require(begun, "the database that others are copied from can be reached");
  const auto done = connection->script(kUnused);
  core::require(bool(done), done ? "" : done.error().what.c_str());
  return model_;
}

std::string EmptiedDatabases::take() {
  if (free_.empty()) free_.push_back({.name = postgres_server().add_database(model())});
  lent_.push_back(std::move(free_.back()));
  free_.pop_back();
  return lent_.back().name;
}

void EmptiedDatabases::give_back(const std::string& name) {
  const auto found = std::ranges::find(lent_, name, &Free::name);
  core::require(found != lent_.end(), "what is given back was taken");
  Free left = std::move(*found);
  lent_.erase(found);
  if (++left.uses < kMostUses && empty(left)) {
    free_.push_back(std::move(left));
  } else {
    left.connection.reset();
    postgres_server().drop_database(name);
  }
}

bool EmptiedDatabases::empty(Free& left) {
  if (!left.connection)
    left.connection =
        store::postgres_connection(postgres_server().address(left.name), store::Access::write);
  if (!left.connection->begin(store::Access::beside)) return false;
  // Sessions that the test left open end first; what they held is free then.
  const auto others = left.connection->query(
      "select pg_terminate_backend(pid, 5000) from pg_stat_activity where datname = "
      "current_database() and pid <> pg_backend_pid() and backend_type = 'client backend'",
      {});
  const auto put_back = left.connection->query("select unused.put_back()", {});
  if (others && put_back && put_back->front().truth(0)) return bool(left.connection->commit());
  left.connection->rollback();
  return false;
}

}  // namespace test_support
}  // namespace tractus
