// A worker in virtual time: it holds leases, finishes each of them after some time, and sends the
// results. All delays are random.

#include "sim_worker.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "farm_driver.h"

namespace bandsaw::coordinator::sim {

void SimWorker::later(double seconds, std::function<void()> what) {
  agenda_.in(seconds, [this, process = process_, what = std::move(what)] {
    if (!running_ || process != process_) {
      return;
    }
    if (agenda_.now() < frozen_until_) {
      later(frozen_until_ - agenda_.now(), what);
    } else {
      what();
    }
  });
}

void SimWorker::start() {
  running_ = true;
  ++process_;
  frozen_until_ = 0;
  held_.clear();
  scenes_.clear();
  rendering_ = 0;
  connect();
  heartbeat();
}

void SimWorker::kill() {
  cut_cable();
  running_ = false;
}

std::string SimWorker::instance() const {
  const std::string number = nature_.number > 0 ? absl::StrCat(" ", nature_.number) : "";
  return absl::StrCat(name_, number, "/", process_);
}

void SimWorker::connect() {
  if (stream_ != nullptr) {
    return;
  }
  if (!coordinator_.up()) {
    later(chance_.between(0.2, 1), [this] { connect(); });
    return;
  }
  stream_ = std::make_shared<Stream>();
  stream_->epoch_number = coordinator_.epoch_number();
  stream_->id =
      coordinator_.open([this, stream = stream_](const Action& action) { down(stream, action); });
  WorkerHello hello;
  hello.instance = instance();
  hello.name = name_;
  hello.protocol = 1;
  hello.pixel_version = 2;
  hello.canary = 3;
  hello.threads = nature_.threads;
  hello.max_bands = nature_.max_bands;
  hello.browser = nature_.browser;
  hello.memory_bytes = nature_.memory_bytes;
  for (const Held& h : held_) {
    hello.held.push_back({h.lease.job, h.lease.band, h.lease.lease, h.epoch, h.finished});
  }
  up(input::Hello{stream_->id, std::move(hello)});
}

void SimWorker::disconnected(double wait) {
  if (stream_ != nullptr) {
    stream_->open = false;
    stream_.reset();
  }
  later(wait, [this] { connect(); });
}

void SimWorker::cut_cable() {
  if (stream_ == nullptr) {
    return;
  }
  const auto stream = stream_;
  if (chance_.happens(0.7)) {
    agenda_.in(chance_.between(0, 3), [this, stream] {
      if (coordinator_.up() && coordinator_.epoch_number() == stream->epoch_number) {
        coordinator_.input(input::SessionEnded{stream->id, "connection reset"});
      }
    });
  }
  disconnected(chance_.between(0.1, 3));
}

void SimWorker::drain() { up(input::Draining{stream_ ? stream_->id : 0, "SIGTERM"}); }

void SimWorker::up(const Input& input) {
  if (stream_ == nullptr) {
    return;
  }
  stream_->up_at = std::max(stream_->up_at, agenda_.now() + chance_.between(0.001, 0.05));
  agenda_.at(stream_->up_at, [this, stream = stream_, input] {
    if (stream->open && coordinator_.up() && coordinator_.epoch_number() == stream->epoch_number) {
      coordinator_.input(input);
    }
  });
}

void SimWorker::down(const std::shared_ptr<Stream>& stream, const Action& action) {
  stream->down_at = std::max(stream->down_at, agenda_.now() + chance_.between(0.001, 0.05));
  agenda_.at(stream->down_at, [this, stream, action] {
    if (stream->open && stream == stream_) {
      later(0, [this, stream, action] {
        if (stream == stream_) {
          receive(action);
        }
      });
    }
  });
}

void SimWorker::receive(const Action& action) {
  if (const auto* lease = std::get_if<action::Lease>(&action)) {
    take(*lease);
  } else if (const auto* revoke = std::get_if<action::Revoke>(&action)) {
    std::for_each(revoke->leases.begin(), revoke->leases.end(), [this](LeaseId id) { drop(id); });
  } else if (std::holds_alternative<action::Welcome>(action)) {
    epoch_ = std::to_string(stream_->epoch_number);
  } else if (std::holds_alternative<action::Close>(action)) {
    disconnected(chance_.between(0.1, 1));
  } else if (std::holds_alternative<action::Refuse>(action)) {
    // The worker is quarantined. After 5 s, a person has checked the machine and restarts the
    // worker.
    disconnected(1e9);
    running_ = false;
    agenda_.in(5, [this] {
      if (!running_) {
        start();
      }
    });
  }
}

SimWorker::Held* SimWorker::find(LeaseId id) {
  const auto it =
      std::find_if(held_.begin(), held_.end(), [&](const Held& h) { return h.lease.lease == id; });
  return it == held_.end() ? nullptr : &*it;
}

void SimWorker::take(const action::Lease& lease) {
  if (Held* held = find(lease.lease)) {  // confirmed after a reconnect
    held->epoch = epoch_;
    return;
  }
  // The scheduler assumes that a scene needs 4 bytes of memory for each byte of its package.
  if (nature_.memory_bytes > 0 &&
      4 * coordinator_.package_bytes(lease.job) > nature_.memory_bytes) {
    coordinator_.fail(absl::StrCat("job ", lease.job, " is too large for ", name_));
  }
  held_.push_back({lease, epoch_, /*finished=*/false, /*digests=*/{}, /*render_s=*/0,
                   /*begun_at=*/-1, /*prepared_at=*/-1, /*hangs=*/false});
  render();
}

void SimWorker::drop(LeaseId id) {
  std::erase_if(held_, [&](const Held& h) { return h.lease.lease == id; });
  if (rendering_ == id) {
    rendering_ = 0;
    render();
  }
}

bool SimWorker::has_deadly_row(const action::Lease& lease) const {
  return lease.job == nature_.dies_of && lease.band.rows.first <= nature_.dies_at_row &&
         nature_.dies_at_row < lease.band.rows.last;
}

void SimWorker::die() {
  kill();
  agenda_.in(1, [this] {
    if (!running_) {
      start();
    }
  });
}

void SimWorker::render() {
  if (rendering_ != 0) {
    return;
  }
  const auto next =
      std::find_if(held_.begin(), held_.end(), [](const Held& h) { return !h.finished; });
  if (next == held_.end()) {
    return;
  }
  const Band& band = next->lease.band;
  rendering_ = next->lease.lease;
  next->begun_at = agenda_.now();
  next->render_s = static_cast<double>(band.samples.samples()) * band.rows.count() *
                   next->lease.settings.width / nature_.samples_per_s * chance_.between(0.7, 1.5);
  const double prepare_s =
      scenes_.insert(next->lease.job).second ? chance_.between_log(0.01, 20) : 0;
  next->prepared_at = agenda_.now() + prepare_s;
  next->hangs = chance_.happens(nature_.hangs);
  if (next->hangs) {
    return;
  }
  later(prepare_s + next->render_s, [this, id = rendering_, begun = next->begun_at] {
    const Held* held = find(id);
    if (rendering_ != id || held == nullptr || held->begun_at != begun) {
      return;
    }
    if (has_deadly_row(held->lease)) {
      die();
    } else {
      finish(id);
    }
  });
}

void SimWorker::finish(LeaseId id) {
  Held& held = *find(id);
  rendering_ = 0;
  ++rendered;
  if (chance_.happens(nature_.fails)) {
    ++failed;
    up(input::BandFailed{stream_ ? stream_->id : 0, id, "out of memory", {}});
    drop(id);
  } else {
    held.finished = true;
    held.digests = honest_digests(held.lease.band);
    for (std::uint64_t& digest : held.digests) {
      digest += chance_.happens(nature_.lies) ? chance_.bits() : 0;
    }
    upload(id);
  }
  render();
}

void SimWorker::upload(LeaseId id) {
  const Held* held = find(id);
  if (held == nullptr || !held->finished) {
    return;
  }
  input::BandStored band;
  band.job = held->lease.job;
  band.band = held->lease.band;
  band.row_digests = held->digests;
  band.instance = instance();
  band.render_s = held->render_s;
  band.cpu_s = held->render_s * nature_.threads;
  // The result arrives once, except in the share `loses` of all cases. Then it is lost or arrives
  // twice.
  const std::size_t times = chance_.happens(nature_.loses) ? chance_.pick(0, 1) * 2 : 1;
  for (std::size_t i = 0; i < times; ++i) {
    agenda_.in(chance_.happens(0.05) ? chance_.between(0, 8) : chance_.between(0.01, 0.1),
               [this, band, id] { send(band, id); });
  }
  later(chance_.between(3, 5), [this, id] { upload(id); });  // again, unless it is acknowledged
}

void SimWorker::send(const input::BandStored& band, LeaseId id) {
  if (!coordinator_.up()) {
    return;
  }
  const auto reply = [this, id, process = process_](PutOutcome outcome) {
    if (process != process_ || outcome == PutOutcome::kTryAgain || chance_.happens(nature_.loses)) {
      return;
    }
    later(chance_.between(0.001, 0.05), [this, id] { drop(id); });
  };
  if (nature_.browser && !coordinator_.scheduler().is_browser(band.instance)) {
    // The real coordinator also refuses the bands of a tab that has not joined.
    reply(PutOutcome::kTryAgain);
  } else {
    coordinator_.put_band(band, reply);
  }
}

void SimWorker::heartbeat() {
  if (stream_ != nullptr &&
      (!coordinator_.up() || coordinator_.epoch_number() != stream_->epoch_number)) {
    disconnected(chance_.between(0, 1));
  }
  if (stream_ != nullptr) {
    input::Heartbeat beat{stream_->id, {}, "rendering"};
    for (const Held& h : held_) {
      const bool begun = h.begun_at >= 0 && !h.hangs;
      const bool preparing = begun && agenda_.now() < h.prepared_at;
      const double done = h.finished            ? 1
                          : begun && !preparing ? (agenda_.now() - h.prepared_at) / h.render_s
                                                : 0;
      beat.leases.push_back(
          {h.lease.lease,
           static_cast<std::uint32_t>(std::min(1.0, done) * h.lease.band.rows.count()),
           preparing ? static_cast<std::uint64_t>((agenda_.now() - h.begun_at) * 1000) : 0});
    }
    up(beat);
  }
  later(1, [this] { heartbeat(); });
}

}  // namespace bandsaw::coordinator::sim
