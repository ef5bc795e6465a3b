// Holds the connections of workers, each with the name and address for the log, and passes the
// scheduler's actions to them.

#include "coordinator/engine/links.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace bandsaw::coordinator {

void Links::add(SessionId session, std::shared_ptr<WorkerLink> link, const WorkerHello& hello) {
  sessions_[session] = {.link = std::move(link), .name = hello.name, .address = hello.address};
}

void Links::lost(SessionId session, const std::string& reason) {
  if (const One* one = find(session)) {
    spdlog::info("worker={} address={} disconnected: {}", one->name, one->address, reason);
    sessions_.erase(session);
  }
}

void Links::perform(const action::Welcome& welcome) {
  if (One* one = find(welcome.session)) {
    one->name = welcome.name;
    spdlog::info("worker={} address={} joined", one->name, one->address);
    one->link->welcome(welcome, epoch_);
  }
}

void Links::perform(const action::Refuse& refuse) {
  if (const One* one = find(refuse.session)) {
    spdlog::warn("worker={} address={} refused: {}", one->name, one->address, refuse.reason);
    one->link->refuse(refuse);
  }
}

void Links::perform(const action::Close& close) {
  if (const One* one = find(close.session)) {
    spdlog::info("worker={} address={} closed: {}", one->name, one->address, close.reason);
    one->link->close(close.reason);
    sessions_.erase(close.session);
  }
}

void Links::perform(const action::Lease& lease) {
  if (const One* one = find(lease.session)) {
    spdlog::debug("worker={} job={} band=[{},{})x[{},{}) lease={} attempt={}", one->name, lease.job,
                  lease.band.samples.first, lease.band.samples.last, lease.band.rows.first,
                  lease.band.rows.last, lease.lease, lease.attempt);
    one->link->lease(lease);
  }
}

void Links::perform(const action::Revoke& revoke) {
  if (const One* one = find(revoke.session)) {
    spdlog::debug("worker={} revoked leases={}", one->name, revoke.leases.size());
    one->link->revoke(revoke);
  }
}

std::string Links::name(SessionId session) const {
  const auto found = sessions_.find(session);
  return found == sessions_.end() ? std::string() : found->second.name;
}

Links::One* Links::find(SessionId session) {
  const auto found = sessions_.find(session);
  return found == sessions_.end() ? nullptr : &found->second;
}

}  // namespace bandsaw::coordinator
