"""Projects: what somebody works on, kept on this computer with every state that it had."""
