// Lambdas as one visitor: std::visit(Overloaded{[](A) {...}, [](B) {...}}, variant).
#pragma once

namespace marrow {

template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;

}  // namespace marrow
