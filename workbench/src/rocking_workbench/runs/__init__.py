"""Long runs in processes of their own: folders that survive the server, a queue, progress, stop and restart."""
