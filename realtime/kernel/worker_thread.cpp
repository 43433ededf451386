// The loop of a real thread, and its start and stop.
#include "realtime/kernel/worker_thread.hpp"

#include <ctime>
#include <string>
#include <system_error>

namespace orcart {
namespace {

Nanos thread_cpu_time() noexcept {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return Nanos{std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec};
}

}  // namespace

Result<void> WorkerThread::start() {
  if (started_)
    return fail("thread '" + std::string(plan_.spec.name) + "' is running already; stop it first");
  if (auto checked = check(plan_); !checked) return checked;
  stop_wanted_.store(
      false, std::memory_order_relaxed);  // partner: pthread_create, which orders it before the thread
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  int error = pthread_attr_setstacksize(&attributes, plan_.spec.stack_bytes);
  if (error == 0) error = pthread_create(&thread_, &attributes, &WorkerThread::entry, this);
  pthread_attr_destroy(&attributes);
  if (error != 0) {
    return fail("thread '" + std::string(plan_.spec.name) + "' with a stack of " +
                std::to_string(plan_.spec.stack_bytes) + " bytes cannot be started (" +
                std::generic_category().message(error) +
                "); a multiple of the page size within the limits on threads and locked memory is accepted");
  }
  started_ = true;
  ready_.acquire();
  return {};
}

void WorkerThread::stop() noexcept {
  if (!started_) return;
  stop_wanted_.store(true, std::memory_order_release);  // partner: the acquire in run()
  pthread_join(thread_, nullptr);
  started_ = false;
}

void* WorkerThread::entry(void* self) {
  auto& worker = *static_cast<WorkerThread*>(self);
  worker.rights_ = acquire_thread_rights(worker.plan_.spec);
  worker.ready_.release();
  worker.run();
  return nullptr;
}

void WorkerThread::run() noexcept {
  for (Stage* stage : plan_.stages) stage->enter_thread();
  loop_.begin(clock_.now());
  // Bound: one turn a wake-up, until stop() is called. Partner of the acquire: the release in stop().
  while (!stop_wanted_.load(std::memory_order_acquire)) {
    const Instant due = loop_.wake_by(clock_.now());
    sleep_until(due);
    if (stop_wanted_.load(std::memory_order_acquire)) break;  // partner: the same
    loop_.woke(clock_.now(), due);
    run_stages();
    loop_.turn_over(clock_.now());
  }
  for (std::size_t i = plan_.stages.size(); i > 0; --i) plan_.stages[i - 1]->leave_thread();
}

void WorkerThread::sleep_until(Instant due) noexcept {
  if (plan_.wake != nullptr) {
    plan_.wake->wait(due);
  } else {
    clock_.sleep_until(due);
  }
}

void WorkerThread::run_stages() noexcept {
  Instant began = clock_.now();
  Nanos cpu_began = thread_cpu_time();
  for (std::size_t i = 0; i < plan_.stages.size(); ++i) {
    const StepReport report = plan_.stages[i]->step(began);
    const Nanos cpu_ended = thread_cpu_time();
    const Instant ended = clock_.now();
    loop_.stepped(i, {.at = began, .wall = ended - began, .cpu = cpu_ended - cpu_began}, report);
    began = ended;
    cpu_began = cpu_ended;
  }
}

}  // namespace orcart
