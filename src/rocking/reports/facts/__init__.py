"""What is said of a body, an impact, a motion and a response: plain values, the same in every door."""
