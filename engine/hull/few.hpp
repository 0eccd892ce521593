// Short lists that store up to eight items without heap memory, which is sufficient for most contacts.
#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <type_traits>

namespace rocking::hull {

template <class T>
class Few {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  public:
    Few() {}
    explicit Few(std::size_t n, T value = T()) { assign(n, value); }
    Few(std::initializer_list<T> all) { assign(all.begin(), all.end()); }
    Few(const Few& o) { assign(o.begin(), o.end()); }
    Few(Few&& o) noexcept { take(o); }
    Few& operator=(const Few& o) {
        if (this != &o) assign(o.begin(), o.end());
        return *this;
    }
    Few& operator=(Few&& o) noexcept {
        if (this != &o) take(o);
        return *this;
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* begin() { return all_; }
    T* end() { return all_ + size_; }
    const T* begin() const { return all_; }
    const T* end() const { return all_ + size_; }
    T& operator[](std::size_t k) { return all_[k]; }
    const T& operator[](std::size_t k) const { return all_[k]; }
    T& back() { return all_[size_ - 1]; }

    void clear() { size_ = 0; }
    void push_back(const T& value) {
        const T kept = value;
        if (size_ == room_) grow(2 * room_);
        all_[size_++] = kept;
    }
    void pop_back() { --size_; }
    void resize(std::size_t n) {
        if (n > size_) fit(n), std::fill(all_ + size_, all_ + n, T());
        size_ = n;
    }
    void assign(std::size_t n, T value) {
        fit(n), size_ = n;
        std::fill(all_, all_ + n, value);
    }
    template <class It>
    std::enable_if_t<!std::is_integral_v<It>> assign(It from, It to) {
        size_ = 0, fit(static_cast<std::size_t>(to - from));
        for (; from != to; ++from) all_[size_++] = static_cast<T>(*from);
    }
    void erase(T* at) { std::copy(at + 1, end(), at), --size_; }

    bool operator==(const Few& o) const { return size_ == o.size_ && std::equal(begin(), end(), o.begin()); }

  private:
    static constexpr std::size_t kRoom = 8;

    void fit(std::size_t n) {
        if (n > room_) grow(n);
    }
    void grow(std::size_t n) {
        std::unique_ptr<T[]> wide(new T[n]);
        std::copy(begin(), end(), wide.get());
        wide_ = std::move(wide), all_ = wide_.get(), room_ = n;
    }
    void take(Few& o) {
        if (!o.wide_) return assign(o.begin(), o.end());
        wide_ = std::move(o.wide_), all_ = wide_.get(), size_ = o.size_, room_ = o.room_;
        o.all_ = o.own(), o.size_ = 0, o.room_ = kRoom;
    }
    T* own() { return reinterpret_cast<T*>(own_); }

    alignas(T) unsigned char own_[kRoom * sizeof(T)];
    T* all_ = own();
    std::size_t size_ = 0, room_ = kRoom;
    std::unique_ptr<T[]> wide_;
};

}  // namespace rocking::hull
