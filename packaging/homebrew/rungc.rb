class Rungc < Formula
  desc "Compiler for programs of FX-family PLCs"
  homepage "https://github.com/rungc/rungc"
  version "@VERSION@"
  license any_of: ["MIT", "Apache-2.0"]

  on_macos do
    depends_on arch: :arm64
    url "https://github.com/rungc/rungc/releases/download/v@VERSION@/rungc-@VERSION@-aarch64-macos.tar.gz"
    sha256 "@SHA256:rungc-@VERSION@-aarch64-macos.tar.gz@"
  end

  on_linux do
    on_intel do
      url "https://github.com/rungc/rungc/releases/download/v@VERSION@/rungc-@VERSION@-x86_64-linux-musl.tar.gz"
      sha256 "@SHA256:rungc-@VERSION@-x86_64-linux-musl.tar.gz@"
    end
    on_arm do
      url "https://github.com/rungc/rungc/releases/download/v@VERSION@/rungc-@VERSION@-aarch64-linux-musl.tar.gz"
      sha256 "@SHA256:rungc-@VERSION@-aarch64-linux-musl.tar.gz@"
    end
  end

  def install
    bin.install "rungc"
    man1.install Dir["man/man1/*.1"]
    bash_completion.install "completions/rungc.bash" => "rungc"
    fish_completion.install "completions/rungc.fish"
    zsh_completion.install "completions/_rungc"
  end

  test do
    system bin/"rungc", "demo", "gate"
    cd "gate" do
      system bin/"rungc", "check"
      system bin/"rungc", "test"
    end
  end
end
