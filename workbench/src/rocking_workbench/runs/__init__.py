"""Long runs in separate processes: folders that survive the server, queue, progress, stop and restart."""
