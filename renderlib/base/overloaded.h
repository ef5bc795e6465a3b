#pragma once

namespace bandsaw {

/// Combines several lambdas into one visitor for std::visit:
/// `Overloaded{[](const A&) { … }, [](const B&) { … }}`.
template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace bandsaw
